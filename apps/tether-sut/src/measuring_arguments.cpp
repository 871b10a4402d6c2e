#include "measuring_arguments.h"

#include "calibration_statistics.h"
#include "common_arguments.h"
#include "profile_text.h"

#include <algorithm>
#include <map>
#include <vector>

#include <CLI/CLI.hpp>

namespace tether::sut {
namespace {

CLI::Validator profile_name() {
  return CLI::Validator(
      [](std::string& text) {
        return is_profile_name(text) ? std::string()
                                     : "\"" + text +
                                           "\" is no name: 1 to 64 letters, digits, '_', '-' and "
                                           "'.', not starting with '.'";
      },
      "NAME");
}

CLI::Validator file_name() {
  return CLI::Validator(
      [](std::string& text) { return text.empty() ? std::string("needs a name") : std::string(); },
      "FILE");
}

/// "12,40,80,60" in whole pixels.
void add_pixel_box(CLI::App& app, const std::string& name, std::optional<PixelBox>& box,
                   const std::string& description) {
  app.add_option_function<std::vector<double>>(
         name,
         [&box](const std::vector<double>& v) {
           box = PixelBox{v[0], v[1], v[2], v[3]};
           if (box->width_px < 1.0 || box->height_px < 1.0) {
             throw CLI::ValidationError("--true-roi-px", "W and H must be at least 1");
           }
         },
         description)
      ->delimiter(',')
      ->expected(4)
      ->check(within(-1e5, 1e5))
      ->type_name("X,Y,W,H");
}

}  // namespace

void add_characterize_options(CLI::App& app, CharacterizeOptions& options) {
  static const std::map<std::string, Timing> kTimings = {
      {"auto", Timing::kAuto}, {"on_demand", Timing::kOnDemand}, {"periodic", Timing::kPeriodic}};
  app.add_option("--sensors", options.sensors,
                 "Names of sensors, separated by commas; all that there are, if not given")
      ->delimiter(',')
      ->type_name("NAME,NAME");
  app.add_option("--acquisitions", options.acquisitions, "Of each experiment")
      ->check(CLI::Range(1, kMostAcquisitions))
      ->capture_default_str();
  app.add_option("--experiments", options.experiments, "Of each sensor; the paper made ten")
      ->check(CLI::Range(1, kMostAcquisitions))
      ->capture_default_str();
  app.add_option(
         "--timing", options.timing,
         "What the profile says: on_demand (from asking to having), periodic (the sensor's "
         "own period and delay), or auto (default: periodic where a sensor tells a rate and "
         "can be modelled so, else on_demand)")
      ->transform(CLI::Transformer(kTimings))
      ->type_name("NAME");
  app.add_option("--name", options.name, "The profile's name; usually the host's")
      ->check(profile_name())
      ->type_name("NAME");
  app.add_option("--out", options.out, "Writes the profile (TOML) to this file")
      ->check(file_name())
      ->type_name("FILE");
  add_seconds(app, "--time-limit-s", options.time_limit, "Gives up a sensor after this time");
}

Status check(const CharacterizeOptions& options) {
  return check_extent(options, std::max<std::size_t>(options.sensors.size(), 1));
}

void add_calibrate_options(CLI::App& app, CalibrateOptions& options) {
  const auto add_file = [&app](const char* name, std::string& file, const char* description) {
    app.add_option(name, file, description)->check(file_name())->type_name("FILE");
  };
  app.add_option("--rounds", options.rounds, "Rounds that count, after three of warming up")
      ->check(CLI::Range(kLeastRounds, 100'000))
      ->capture_default_str();
  app.add_option("--cpu", options.cpu_index,
                 "The core to measure on, from 0; the last that may be used, if not given")
      ->check(CLI::Range(0, 100'000))
      ->type_name("N");
  add_file("--out", options.out, "Writes what was measured (TOML)");
  add_file("--against", options.against,
           "What was measured on another machine: says how many times longer it takes");
  add_file("--measured", options.measured,
           "What was measured on this machine before, instead of measuring now");
  add_file("--write-target", options.target,
           "With --against: writes that machine as a virtual target on this one (TOML)");
  app.add_option("--name", options.name, "The target's name; usually that machine's")
      ->check(profile_name())
      ->type_name("NAME");
}

void add_real_row_options(CLI::App& app, RealRowOptions& options) {
  add_pixel_box(app, "--true-roi-px", options.true_roi,
                "With real devices: the anchor in the image as you annotated it, in whole pixels "
                "from the top left; gives the angle error");
  app.add_option("--keep-image", options.keep_image,
                 "With real devices: writes the last estimate's image, to annotate it (PNG)")
      ->check(file_name())
      ->type_name("FILE");
}

bool is_given(const RealRowOptions& options) {
  return options.true_roi || !options.keep_image.empty();
}

}  // namespace tether::sut
