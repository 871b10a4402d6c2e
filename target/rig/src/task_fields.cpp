#include <array>
#include <utility>

#include <tether/base/units.h>
#include <tether/rig/task_fields.h>

namespace tether::rig {
namespace {

using Fields = std::vector<Field>;

constexpr double kLeastTime_s = 0.001;

/// A number that is kept in the unit in which it is written.
NumberField plain(double& value, double least, double most) {
  return {least, most, value, [&value](double number) { value = number; }};
}

NumberField share(double& value) {
  return plain(value, 0.0, 1.0);
}

NumberField seconds(Duration& value, double least_s = kLeastTime_s) {
  return {least_s, 1e6, to_seconds(value),
          [&value](double number) { value = duration_from_seconds(number); }};
}

/// An angle or a rate that is kept in radians.
NumberField degrees(double& radians, double least_deg, double most_deg) {
  return {least_deg, most_deg, deg_from_rad(radians),
          [&radians](double number) { radians = rad_from_deg(number); }};
}

Fields joined(std::vector<Fields> groups) {
  Fields all;
  for (Fields& group : groups) {
    all.insert(all.end(), std::make_move_iterator(group.begin()),
               std::make_move_iterator(group.end()));
  }
  return all;
}

// Arguments that several tasks have ---------------------------------------------------------------

Field time_limit(Duration& value) {
  return {"time_limit_s", "Gives up after this time of its own clock", seconds(value)};
}

Field settling(Duration& value) {
  return {"settle_s", "By the IMU's readings, after the final stop, while the UAV comes to rest",
          seconds(value, 0.0)};
}

Field speed(double& value) {
  return {"speed_m_s", "Of moving", plain(value, 0.001, 5.0)};
}

/// When an estimate has converged.
Fields convergence_fields(tasks::ConvergenceOptions& options) {
  return {
      {"tolerance_px",
       "An estimate has converged when the ROI is where it was expected within this ...",
       plain(options.tolerance_px, 1e-6, 1e6)},
      {"stable_frames", "... for so many images in a row",
       IntegerField{&options.stable_frames, 1, 1000}},
      {"max_frames", "Images after which an estimate is given up",
       IntegerField{&options.max_frames, 2, 100'000}},
      {"max_unseen_frames", "Images in a row without the anchor after which it is given up",
       IntegerField{&options.max_unseen_frames, 1, 100'000}},
  };
}

/// How "face anchor" turns; neither its precision nor its time limit.
Fields turning_fields(tasks::FaceAnchorOptions& options) {
  return joined(
      {{{"yaw_rate_deg_s", "Rotation at first", degrees(options.yaw_rate_rad_s, 0.01, 720.0)},
        {"slowdown", "Factor of the rotation at each overshoot",
         plain(options.slowdown, 0.01, 1.0)},
        {"min_yaw_rate_deg_s", "Never slower than this",
         degrees(options.min_yaw_rate_rad_s, 0.01, 720.0)},
        {"search_clockwise", "true or false: which way to turn while the anchor was never seen",
         BooleanField{&options.search_clockwise}},
        {"lost_limit_s", "Gives up so long after the last sight", seconds(options.lost_limit)}},
       convergence_fields(options.convergence)});
}

// The arguments of each task ----------------------------------------------------------------------

Fields fields(tasks::SensorCharacterizationOptions& options, TaskSpec& spec) {
  return {{"sensor", "Name of the sensor, of any kind", TextField{&spec.sensor, true}},
          {"acquisitions", "How many", IntegerField{&options.acquisitions, 1, 10'000'000}},
          time_limit(options.time_limit)};
}

Fields fields(tasks::RelativePositionOptions& options, TaskSpec& spec) {
  return joined({vision_fields(spec),
                 convergence_fields(options.convergence),
                 {time_limit(options.time_limit)}});
}

Fields fields(tasks::FaceAnchorOptions& options, TaskSpec& spec) {
  return joined({vision_fields(spec),
                 {{"precision_deg", "The goal: bearing at most this",
                   degrees(options.precision_rad, 0.001, 90.0)}},
                 turning_fields(options),
                 {time_limit(options.time_limit)}});
}

Fields fields(tasks::MoveForwardOptions& options, TaskSpec& spec) {
  return joined({vision_fields(spec),
                 {speed(options.speed_m_s),
                  {"precision_deg", "Faces the anchor when its bearing is more than this",
                   degrees(options.precision_rad, 0.001, 90.0)},
                  {"face_precision_deg", "Facing it: until its bearing is at most this",
                   degrees(options.face.precision_rad, 0.001, 90.0)},
                  {"face_time_limit_s", "Facing it: moves on after this time",
                   seconds(options.face.time_limit)},
                  {"stop_to_face", "true or false: stop while turning towards the anchor",
                   BooleanField{&options.stop_to_face}}},
                 turning_fields(options.face),
                 {{"imu", "Name of the IMU that tells the heading, or a real one's device",
                   TextField{&options.face.imu}},
                  settling(options.settle_time),
                  time_limit(options.time_limit)}});
}

Fields fields(tasks::ClosedPathOptions& options, TaskSpec& spec) {
  return joined(
      {vision_fields(spec),
       {{"distance_m", "Length of each of the four legs", plain(options.distance_m, 0.01, 1000.0)},
        speed(options.speed_m_s),
        {"imu", "Name of the IMU, or a real one's device", TextField{&options.imu}},
        {"rest_s", "By the IMU's readings, before the start; its bias is taken from them",
         seconds(options.rest_time, 0.0)},
        {"turn_rate_deg_s", "Turning back to the start heading: at most this fast",
         degrees(options.turn_rate_rad_s, 0.01, 720.0)},
        {"turn_tolerance_deg", "... until the heading is off by at most this",
         degrees(options.turn_tolerance_rad, 0.01, 90.0)},
        settling(options.settle_time)},
       convergence_fields(options.convergence),
       {{"turn_limit_s", "Gives up turning back after this", seconds(options.turn_limit)},
        {"leg_slack_s", "Gives up a leg after five times its time and this",
         seconds(options.leg_slack)},
        time_limit(options.time_limit)}});
}

}  // namespace

std::span<const TaskKind> task_kinds() {
  static const std::array kKinds = {
      TaskKind{"sensor_characterization", "Time the acquisition of a sensor's data",
               tasks::SensorCharacterizationOptions{}},
      TaskKind{"relative_position", "Measure bearing and distance of the anchor",
               tasks::RelativePositionOptions{}},
      TaskKind{"face_anchor", "Turn until the anchor is straight ahead",
               tasks::FaceAnchorOptions{}},
      TaskKind{"move_forward", "Move ahead facing the anchor until it is abeam",
               tasks::MoveForwardOptions{}},
      TaskKind{"closed_path", "Fly a square by the IMU and see how far from its start it ends",
               tasks::ClosedPathOptions{}}};
  return kKinds;
}

std::vector<Field> fields_of(TaskSpec& spec) {
  return std::visit([&spec](auto& options) { return fields(options, spec); }, spec.options);
}

std::vector<Field> vision_fields(TaskSpec& spec) {
  using vision::Prefilter;
  static constexpr std::array kPrefilters = {Prefilter::kNone, Prefilter::kGaussian,
                                             Prefilter::kMedian};
  vision::TrackerOptions& tracker = spec.vision.tracker;
  return {
      {"anchor", "Name of the anchor", TextField{&spec.anchor, true}},
      {"camera", "Name of the camera, or a real one's device", TextField{&spec.vision.camera}},
      {"prefilter", "Smoothing of each image: none, gaussian (default) or median",
       ChoiceField{{"none", "gaussian", "median"},
                   [&tracker](std::size_t index) { tracker.prefilter = kPrefilters[index]; }}},
      {"prefilter_size_px", "Odd, 1 to 31", IntegerField{&tracker.prefilter_size_px, 1, 31, true}},
      {"hue_tolerance_deg", "About the anchor's hue", plain(tracker.hue_tolerance_deg, 0.1, 90.0)},
      {"min_saturation", "Of the anchor's pixels, 0 to 1", share(tracker.min_saturation)},
      {"min_value", "Of the anchor's pixels, 0 to 1", share(tracker.min_value)},
      {"min_score", "Below it the anchor is lost, 0 to 1", share(tracker.min_score)},
  };
}

}  // namespace tether::rig
