#include "common_arguments.h"

#include <cmath>
#include <map>

namespace tether::sut {
namespace {

/// A number as defaults are shown: 25, not 25.000000000000004.
std::string shown(double value) {
  return CLI::detail::to_string(std::round(value * 1e9) / 1e9);
}

}  // namespace

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

CLI::Option* add_seconds(CLI::App& app, const std::string& name, Duration& duration,
                         const std::string& description, double least_s) {
  const std::string usual = shown(to_seconds(duration));
  return app
      .add_option_function<double>(
          name, [&duration](double value) { duration = duration_from_seconds(value); }, description)
      ->check(within(least_s, 1e6))
      ->default_str(usual);
}

CLI::Option* add_degrees(CLI::App& app, const std::string& name, double& radians,
                         const std::string& description, double least_deg, double most_deg) {
  const std::string usual = shown(deg_from_rad(radians));
  return app
      .add_option_function<double>(
          name, [&radians](double value) { radians = rad_from_deg(value); }, description)
      ->check(within(least_deg, most_deg))
      ->default_str(usual);
}

namespace {

CLI::Validator odd() {
  return CLI::Validator(
      [](std::string& text) {
        const bool is_odd = !text.empty() && (text.back() - '0') % 2 == 1;
        return is_odd ? std::string() : text + " is not odd";
      },
      "odd");
}

}  // namespace

void add_vision_options(CLI::App& app, TaskSpec& spec) {
  using vision::Prefilter;
  static const std::map<std::string, Prefilter> kPrefilters = {{"none", Prefilter::kNone},
                                                               {"gaussian", Prefilter::kGaussian},
                                                               {"median", Prefilter::kMedian}};
  vision::TrackerOptions& tracker = spec.vision.tracker;
  const CLI::Validator share = within(0.0, 1.0);
  app.add_option("--anchor", spec.anchor, "Name of the anchor")->required();
  app.add_option("--camera", spec.vision.camera, "Name of the camera, or a real one's device")
      ->capture_default_str();
  app.add_option("--prefilter", tracker.prefilter,
                 "Smoothing of each image: none, gaussian (default) or median")
      ->transform(CLI::Transformer(kPrefilters))
      ->type_name("NAME");
  app.add_option("--prefilter-size-px", tracker.prefilter_size_px, "Odd, 1 to 31")
      ->check(CLI::Range(1, 31))
      ->check(odd())
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

void add_turning_options(CLI::App& app, tasks::FaceAnchorOptions& options) {
  add_degrees(app, "--yaw-rate-deg-s", options.yaw_rate_rad_s, "Rotation at first", 0.01, 720.0);
  app.add_option("--slowdown", options.slowdown, "Factor of the rotation at each overshoot")
      ->check(within(0.01, 1.0))
      ->capture_default_str();
  add_degrees(app, "--min-yaw-rate-deg-s", options.min_yaw_rate_rad_s, "Never slower than this",
              0.01, 720.0);
  app.add_option("--search-clockwise", options.search_clockwise,
                 "true or false: which way to turn while the anchor was never seen")
      ->capture_default_str();
  add_seconds(app, "--lost-limit-s", options.lost_limit, "Gives up so long after the last sight");
  add_convergence_options(app, options.convergence);
}

}  // namespace tether::sut
