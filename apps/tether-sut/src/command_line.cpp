#include "command_line.h"

#include <cmath>
#include <map>
#include <sstream>

#include <CLI/CLI.hpp>

#include <tether/base/time.h>
#include <tether/base/units.h>
#include <tether/base/version.h>

namespace tether::sut {
namespace {

constexpr const char* kDescription =
    "The paper's tasks as a program for the target: connects to Tether's coordinator and flies.";

constexpr const char* kExamples = R"(
Examples:
  tether-sut face_anchor --anchor blue_box
  tether-sut face_anchor --anchor blue_box --precision-deg 1 --yaw-rate-deg-s 30
  tether-sut relative_position --anchor blue_box --address 192.168.1.10:4810
  TETHER_CLOCK='cpu*20' tether-sut face_anchor --anchor blue_box

Environment (set by `tether run` for the SUT that it starts):
  TETHER_ADDRESS  the coordinator, host:port
  TETHER_TOKEN    the run's token, as the coordinator prints it
  TETHER_UAV      which UAV to fly; may be empty if there is only one
  TETHER_CLOCK    wall, cpu, or cpu*FACTOR for a virtual target FACTOR times slower

Exit codes: 0 the goal was reached; 1 it was not; 2 wrong use; 3 set-up or link failed.)";

/// Like CLI::Range, which lets NaN through.
CLI::Validator within(double least, double most) {
  const CLI::Range range(least, most);
  return CLI::Validator(
      [range](std::string& text) {
        double value = 0.0;
        const bool is_nan = CLI::detail::lexical_cast(text, value) && std::isnan(value);
        return is_nan ? std::string("nan is no number") : range(text);
      },
      range.get_description());
}

/// Values as a person writes them; the tasks' own options hold the defaults.
struct Written {
  tasks::FaceAnchorOptions face;
  double precision_deg = deg_from_rad(face.precision_rad);
  double yaw_rate_deg_s = deg_from_rad(face.yaw_rate_rad_s);
  double min_yaw_rate_deg_s = deg_from_rad(face.min_yaw_rate_rad_s);
  double lost_limit_s = to_seconds(face.lost_limit);
  double time_limit_s = to_seconds(face.time_limit);
};

void add_link_options(CLI::App& app, CommandLine& line) {
  app.add_option("--address", line.address,
                 "The coordinator, host:port (overrides TETHER_ADDRESS)");
  app.add_option("--uav", line.uav, "Which UAV to fly (overrides TETHER_UAV)");
  app.add_option("--clock", line.clock, "wall, cpu or cpu*FACTOR (overrides TETHER_CLOCK)");
}

void add_vision_options(CLI::App& app, Mission& mission) {
  using vision::Prefilter;
  static const std::map<std::string, Prefilter> kPrefilters = {{"none", Prefilter::kNone},
                                                               {"gaussian", Prefilter::kGaussian},
                                                               {"median", Prefilter::kMedian}};
  vision::TrackerOptions& tracker = mission.tracker;
  const CLI::Validator share = within(0.0, 1.0);
  app.add_option("--anchor", mission.anchor, "Name of the anchor")->required();
  app.add_option("--camera", mission.camera, "Name of the camera")->capture_default_str();
  app.add_option("--prefilter", tracker.prefilter,
                 "Smoothing of each image: none, gaussian (default) or median")
      ->transform(CLI::Transformer(kPrefilters))
      ->type_name("NAME");
  app.add_option("--prefilter-size-px", tracker.prefilter_size_px, "Odd, 1 to 31")
      ->capture_default_str();
  app.add_option("--hue-tolerance-deg", tracker.hue_tolerance_deg, "About the anchor's hue")
      ->check(within(0.1, 90.0))
      ->capture_default_str();
  app.add_option("--min-saturation", tracker.min_saturation, "Of the anchor's pixels, 0 to 1")
      ->check(share)
      ->capture_default_str();
  app.add_option("--min-value", tracker.min_value, "Of the anchor's pixels, 0 to 1")
      ->check(share)
      ->capture_default_str();
  app.add_option("--min-score", tracker.min_score, "Below it the anchor is lost, 0 to 1")
      ->check(share)
      ->capture_default_str();
}

void add_convergence_options(CLI::App& app, tasks::ConvergenceOptions& options) {
  app.add_option("--tolerance-px", options.tolerance_px,
                 "An estimate has converged when the ROI is where it was expected within this ...")
      ->check(within(1e-6, 1e6))
      ->capture_default_str();
  app.add_option("--stable-frames", options.stable_frames, "... for so many images in a row")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--max-frames", options.max_frames, "Images after which an estimate is given up")
      ->check(CLI::Range(2, 100000))
      ->capture_default_str();
  app.add_option("--max-unseen-frames", options.max_unseen_frames,
                 "Images in a row without the anchor after which it is given up")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
}

void add_face_anchor_options(CLI::App& app, Written& written) {
  const CLI::Validator seconds = within(0.001, 1e6);
  app.add_option("--precision-deg", written.precision_deg, "The goal: bearing at most this")
      ->check(within(0.001, 90.0))
      ->capture_default_str();
  app.add_option("--yaw-rate-deg-s", written.yaw_rate_deg_s, "Rotation at first")
      ->check(within(0.01, 720.0))
      ->capture_default_str();
  app.add_option("--slowdown", written.face.slowdown, "Factor of the rotation at each overshoot")
      ->check(within(0.01, 1.0))
      ->capture_default_str();
  app.add_option("--min-yaw-rate-deg-s", written.min_yaw_rate_deg_s, "Never slower than this")
      ->check(within(0.01, 720.0))
      ->capture_default_str();
  app.add_option("--search-clockwise", written.face.search_clockwise,
                 "true or false: which way to turn while the anchor was never seen")
      ->capture_default_str();
  app.add_option("--lost-limit-s", written.lost_limit_s, "Gives up so long after the last sight")
      ->check(seconds)
      ->capture_default_str();
  app.add_option("--time-limit-s", written.time_limit_s,
                 "Gives up after this time of its own clock")
      ->check(seconds)
      ->capture_default_str();
}

tasks::FaceAnchorOptions face_anchor_options(const Written& written) {
  tasks::FaceAnchorOptions options = written.face;
  options.precision_rad = rad_from_deg(written.precision_deg);
  options.yaw_rate_rad_s = rad_from_deg(written.yaw_rate_deg_s);
  options.min_yaw_rate_rad_s = rad_from_deg(written.min_yaw_rate_deg_s);
  options.lost_limit = duration_from_seconds(written.lost_limit_s);
  options.time_limit = duration_from_seconds(written.time_limit_s);
  return options;
}

/// CLI11's own words for --help and --version; one line for a mistake.
Refusal refusal(const CLI::App& app, const CLI::ParseError& error) {
  if (error.get_exit_code() == 0) {
    std::ostringstream out;
    app.exit(error, out, out);
    return {0, out.str()};
  }
  return {2, "tether-sut: " + std::string(error.what()) + " (see tether-sut --help)\n"};
}

}  // namespace

std::variant<CommandLine, Refusal> parse_command_line(int argc, const char* const* argv) {
  CommandLine line;
  Written written;
  CLI::App app(kDescription, "tether-sut");
  app.set_version_flag("--version", "tether-sut " + std::string(version()));
  app.footer(kExamples);
  app.require_subcommand(1);

  CLI::App* face = app.add_subcommand("face_anchor", "Turn until the anchor is straight ahead");
  add_link_options(*face, line);
  add_vision_options(*face, line.mission);
  add_face_anchor_options(*face, written);
  add_convergence_options(*face, written.face.convergence);
  face->footer(kExamples);

  tasks::ConvergenceOptions convergence;
  CLI::App* relative =
      app.add_subcommand("relative_position", "Measure bearing and distance of the anchor");
  add_link_options(*relative, line);
  add_vision_options(*relative, line.mission);
  add_convergence_options(*relative, convergence);
  relative->footer(kExamples);

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return refusal(app, error);
  }
  if (face->parsed()) {
    line.mission.task = face_anchor_options(written);
  } else {
    line.mission.task = convergence;
  }
  return line;
}

}  // namespace tether::sut
