#include <array>
#include <utility>

#include <tether/base/units.h>
#include <tether/rig/mission.h>

// The arguments of each task as data. Helper functions make fields in the units of an argument
// (degrees, seconds) that write to the options in SI units; one function per task lists its
// fields.
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
  return {"time_limit_s", "Time limit of the task, on its own clock", seconds(value)};
}

Field settling(Duration& value) {
  return {"settle_s", "Pause after the final stop, by the IMU's timestamps", seconds(value, 0.0)};
}

Field speed(double& value, double least_m_s = 0.001) {
  return {"speed_m_s", "Speed of the motion", plain(value, least_m_s, 5.0)};
}

/// When an estimate has converged.
Fields convergence_fields(tasks::ConvergenceOptions& options) {
  return {
      {"tolerance_px", "Converged: the ROI is within this distance of its prediction ...",
       plain(options.tolerance_px, 1e-6, 1e6)},
      {"stable_frames", "... in this number of consecutive images",
       IntegerField{&options.stable_frames, 1, 1000}},
      {"max_frames", "Maximum number of images for an estimate",
       IntegerField{&options.max_frames, 2, 100'000}},
      {"max_unseen_frames", "Maximum number of consecutive images without the anchor",
       IntegerField{&options.max_unseen_frames, 1, 100'000}},
  };
}

/// How "face anchor" turns; neither its precision nor its time limit.
Fields turning_fields(tasks::FaceAnchorOptions& options) {
  return joined(
      {{{"yaw_rate_deg_s", "Initial yaw rate", degrees(options.yaw_rate_rad_s, 0.01, 720.0)},
        {"slowdown", "Factor of the yaw rate at each overshoot",
         plain(options.slowdown, 0.01, 1.0)},
        {"min_yaw_rate_deg_s", "Minimum yaw rate",
         degrees(options.min_yaw_rate_rad_s, 0.01, 720.0)},
        {"search_clockwise", "Clockwise: direction of the turn until the anchor is first seen",
         BooleanField{&options.search_clockwise}},
        {"lost_limit_s", "Maximum time without seeing the anchor", seconds(options.lost_limit)}},
       convergence_fields(options.convergence)});
}

// The arguments of each task ----------------------------------------------------------------------

Fields fields(tasks::SensorCharacterizationOptions& options, TaskSpec& spec) {
  return {{"sensor", "Name of the sensor, of any kind", TextField{&spec.sensor, true}},
          {"acquisitions", "Number of acquisitions",
           IntegerField{&options.acquisitions, 1, 10'000'000}},
          time_limit(options.time_limit)};
}

Fields fields(tasks::RelativePositionOptions& options, TaskSpec& spec) {
  return joined({vision_fields(spec),
                 convergence_fields(options.convergence),
                 {time_limit(options.time_limit)}});
}

Fields fields(tasks::FaceAnchorOptions& options, TaskSpec& spec) {
  return joined({vision_fields(spec),
                 {{"precision_deg", "Goal: maximum bearing of the anchor",
                   degrees(options.precision_rad, 0.001, 90.0)}},
                 turning_fields(options),
                 {time_limit(options.time_limit)}});
}

Fields fields(tasks::MoveForwardOptions& options, TaskSpec& spec) {
  return joined({vision_fields(spec),
                 {speed(options.speed_m_s),
                  {"precision_deg", "Turns to the anchor if its bearing exceeds this",
                   degrees(options.precision_rad, 0.001, 90.0)},
                  {"face_precision_deg", "While turning: maximum bearing at the end",
                   degrees(options.face.precision_rad, 0.001, 90.0)},
                  {"face_time_limit_s", "While turning: time limit, after which it moves on",
                   seconds(options.face.time_limit)},
                  {"stop_to_face", "Stop while turning towards the anchor",
                   BooleanField{&options.stop_to_face}}},
                 turning_fields(options.face),
                 {{"imu", "Name of the IMU for the heading, or the device of a real one",
                   TextField{&options.face.imu}},
                  settling(options.settle_time),
                  time_limit(options.time_limit)}});
}

Fields fields(tasks::ClosedPathOptions& options, TaskSpec& spec) {
  return joined(
      {vision_fields(spec),
       {{"distance_m", "Length of each of the four legs", plain(options.distance_m, 0.01, 1000.0)},
        speed(options.speed_m_s),
        {"imu", "Name of the IMU, or the device of a real one", TextField{&options.imu}},
        {"rest_s", "Pause before the start, in which the IMU's bias is measured",
         seconds(options.rest_time, 0.0)},
        {"turn_rate_deg_s", "Turn back to the start heading: maximum yaw rate",
         degrees(options.turn_rate_rad_s, 0.01, 720.0)},
        {"turn_tolerance_deg", "... and maximum heading error at its end",
         degrees(options.turn_tolerance_rad, 0.01, 90.0)},
        settling(options.settle_time)},
       convergence_fields(options.convergence),
       {{"turn_limit_s", "Time limit of turning back", seconds(options.turn_limit)},
        {"leg_slack_s", "Time limit of a leg: five times its duration plus this",
         seconds(options.leg_slack)},
        time_limit(options.time_limit)}});
}

Field imu(std::string& name) {
  return {"imu", "Name of the IMU, or the device of a real one", TextField{&name}};
}
/// The pauses before the start of dead reckoning.
Fields rest(Duration& settle_time, Duration& rest_time) {
  return {{"settle_s", "Pause after the stop, by the IMU's timestamps", seconds(settle_time, 0.0)},
          {"rest_s", "The pause after that, in which the IMU's bias is measured",
           seconds(rest_time, 0.0)}};
}

Fields fields(tasks::GoToOptions& options, TaskSpec&) {
  return joined({{{"ahead_m", "Goal: distance along the heading at the start",
                   plain(options.ahead_m, -1000.0, 1000.0)},
                  {"left_m", "... to its left", plain(options.left_m, -1000.0, 1000.0)},
                  {"up_m", "... and up", plain(options.up_m, -1000.0, 1000.0)},
                  speed(options.speed_m_s),
                  {"tolerance_m", "The goal is reached within this distance",
                   plain(options.tolerance_m, 0.001, 100.0)},
                  imu(options.imu)},
                 rest(options.settle_time, options.rest_time),
                 {time_limit(options.time_limit)}});
}

Fields fields(tasks::SearchOptions& options, TaskSpec& spec) {
  return joined(
      {vision_fields(spec),
       {{"yaw_rate_deg_s", "Yaw rate", degrees(options.yaw_rate_rad_s, 0.01, 720.0)},
        {"search_clockwise", "Clockwise: direction of the turn", BooleanField{&options.clockwise}},
        {"frames", "Number of consecutive images in which the anchor must be seen",
         IntegerField{&options.frames, 1, 1000}},
        time_limit(options.time_limit)}});
}

Fields fields(tasks::HoldOptions& options, TaskSpec&) {
  return {{"duration_s", "How long it hovers, by the IMU's timestamps", seconds(options.duration)},
          imu(options.imu)};
}

Fields fields(tasks::InspectOptions& options, TaskSpec& spec) {
  return joined(
      {vision_fields(spec),
       {{"distance_m", "Wanted distance from the camera to the anchor",
         plain(options.distance_m, 0.01, 1000.0)},
        {"duration_s", "How long the anchor must be kept there, by the images' timestamps",
         seconds(options.duration)},
        {"distance_tolerance_m", "Maximum error of the distance",
         plain(options.distance_tolerance_m, 0.001, 100.0)},
        {"bearing_tolerance_deg", "Maximum bearing of the anchor",
         degrees(options.bearing_tolerance_rad, 0.01, 90.0)},
        speed(options.speed_m_s),
        {"yaw_rate_deg_s", "Maximum yaw rate", degrees(options.yaw_rate_rad_s, 0.01, 720.0)},
        {"yaw_gain_per_s", "Yaw rate for each radian of the bearing",
         plain(options.yaw_gain_per_s, 0.01, 20.0)},
        {"speed_gain_per_s", "Speed for each metre of the distance's error",
         plain(options.speed_gain_per_s, 0.01, 20.0)},
        {"lost_limit_s", "Maximum time without seeing the anchor", seconds(options.lost_limit)},
        {"least_charge", "It ends below this share of the battery's capacity; 0: not read",
         share(options.least_charge)},
        time_limit(options.time_limit)}});
}

Fields fields(tasks::LandOnOptions& options, TaskSpec& spec) {
  return joined(
      {vision_fields(spec),
       {speed(options.speed_m_s),
        {"descent_m_s", "Speed of the descent", plain(options.descent_m_s, 0.05, 2.0)},
        {"gain_per_s", "Speed for each metre beside the anchor",
         plain(options.gain_per_s, 0.01, 20.0)},
        {"commit_height_m", "Height below which the UAV sinks without looking",
         plain(options.commit_height_m, 0.0, 100.0)},
        {"range", "Rangefinder that looks down", TextField{&options.range}},
        imu(options.imu),
        {"lost_limit_s", "Maximum time without seeing the anchor", seconds(options.lost_limit)},
        time_limit(options.time_limit)}});
}

Fields fields(tasks::LandOptions& options, TaskSpec&) {
  return joined({{speed(options.speed_m_s, 0.15), imu(options.imu)},
                 rest(options.settle_time, options.rest_time),
                 {time_limit(options.time_limit)}});
}

Fields fields(tasks::SearchPairOptions& options, TaskSpec& spec) {
  return joined(
      {fields(options.search, spec),
       {{"partner_ahead_m", "Where the other UAV starts: along the heading at the start",
         plain(options.partner_ahead_m, -1000.0, 1000.0)},
        {"partner_left_m", "... and to its left", plain(options.partner_left_m, -1000.0, 1000.0)},
        {"gap_m", "Distance kept to it", plain(options.gap_m, 0.01, 1000.0)},
        {"repeat_s", "Time between two messages", seconds(options.repeat)},
        speed(options.speed_m_s),
        imu(options.imu)}});
}

Fields fields(tasks::AvoidByScanOptions& options, TaskSpec&) {
  return {{"distance_m", "Goal: distance of the line from the start, along the heading",
           plain(options.distance_m, 0.1, 1000.0)},
          speed(options.speed_m_s),
          {"max_acceleration_m_s2", "Acceleration along the predicted paths",
           plain(options.max_acceleration_m_s2, 0.1, 50.0)},
          {"reaction_s", "Time before the UAV follows a command, along those paths",
           seconds(options.reaction, 0.0)},
          {"radius_m", "Distance to obstacles that each path keeps",
           plain(options.radius_m, 0.0, 100.0)},
          {"margin_m", "Distance beyond that for which it makes detours",
           plain(options.margin_m, 0.0, 100.0)},
          {"horizon_s", "Duration of the predicted paths", seconds(options.horizon, 0.01)},
          {"step_s", "Time between two points of a path", seconds(options.step)},
          {"directions", "Number of directions of the velocities to choose from",
           IntegerField{&options.directions, 1, 3600}},
          {"speeds", "Number of speeds in each direction", IntegerField{&options.speeds, 1, 1000}},
          {"lidar", "Name of the lidar", TextField{&options.lidar}},
          {"odometry", "Name of the odometry", TextField{&options.odometry}},
          time_limit(options.time_limit)};
}

Fields fields(tasks::FlyThroughGatesOptions& options, TaskSpec& spec) {
  Fields vision = vision_fields(spec);
  std::erase_if(vision, [](const Field& field) { return field.name == "anchor"; });  // it takes all
  return joined(
      {vision,
       {speed(options.speed_m_s),
        {"max_acceleration_m_s2", "Maximum acceleration, ahead and across",
         plain(options.max_acceleration_m_s2, 0.1, 50.0)},
        {"stiffness_per_s2", "Acceleration for each metre beside the gate's middle",
         plain(options.stiffness_per_s2, 0.01, 1000.0)},
        {"damping_per_s", "Acceleration against each m/s across",
         plain(options.damping_per_s, 0.0, 1000.0)},
        {"run_out_m", "Goal: distance behind the last gate", plain(options.run_out_m, 0.0, 1000.0)},
        imu(options.imu),
        {"odometry", "Name of the odometry", TextField{&options.odometry}},
        time_limit(options.time_limit)}});
}

}  // namespace

std::span<const TaskKind> task_kinds() {
  static const std::array kKinds = {
      TaskKind{"sensor_characterization", "Measure the time to acquire a sensor's data",
               tasks::SensorCharacterizationOptions{}},
      TaskKind{"relative_position", "Measure bearing and distance of the anchor",
               tasks::RelativePositionOptions{}},
      TaskKind{"face_anchor", "Turn until the anchor is straight ahead",
               tasks::FaceAnchorOptions{}},
      TaskKind{"move_forward", "Move ahead facing the anchor until it is abeam",
               tasks::MoveForwardOptions{}},
      TaskKind{"closed_path",
               "Fly a square by dead reckoning and measure the distance to its start",
               tasks::ClosedPathOptions{}},
      TaskKind{"go_to", "Fly to a relative position by dead reckoning", tasks::GoToOptions{}},
      TaskKind{"search", "Turn until the anchor is seen", tasks::SearchOptions{}},
      TaskKind{"hold", "Hover for a time", tasks::HoldOptions{}},
      TaskKind{"inspect", "Keep the anchor ahead at a distance for a time",
               tasks::InspectOptions{}},
      TaskKind{"land_on", "Land on an anchor, which may move", tasks::LandOnOptions{}},
      TaskKind{"land", "Descend until the UAV stands", tasks::LandOptions{}},
      TaskKind{"search_pair", "Turn until this UAV or another one sees the anchor; the other comes",
               tasks::SearchPairOptions{}},
      TaskKind{"avoid_by_scan", "Cross a field of obstacles by the scans of a lidar",
               tasks::AvoidByScanOptions{}},
      TaskKind{"fly_through_gates", "Fly through all anchors, as through gates",
               tasks::FlyThroughGatesOptions{}}};
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
      {"camera", "Name of the camera, or the device of a real one", TextField{&spec.vision.camera}},
      {"prefilter", "Smoothing of each image: none, gaussian or median [gaussian]",
       ChoiceField{{"none", "gaussian", "median"},
                   [&tracker](std::size_t index) { tracker.prefilter = kPrefilters[index]; }}},
      {"prefilter_size_px", "Size of that filter, odd",
       IntegerField{&tracker.prefilter_size_px, 1, 31, true}},
      {"hue_tolerance_deg", "Tolerance around the anchor's hue",
       plain(tracker.hue_tolerance_deg, 0.1, 90.0)},
      {"min_saturation", "Minimum saturation of the anchor's pixels",
       share(tracker.min_saturation)},
      {"min_value", "Minimum value of the anchor's pixels", share(tracker.min_value)},
      {"min_score", "Score below which the anchor counts as lost", share(tracker.min_score)},
  };
}

}  // namespace tether::rig
