#pragma once

#include "dead_reckoning.h"

#include <optional>
#include <string>
#include <string_view>

#include <tether/base/result.h>
#include <tether/base/time.h>
#include <tether/client/vehicle.h>
#include <tether/tasks/paper_tasks.h>
#include <tether/tasks/task.h>
#include <tether/vision/anchor_tracker.h>

/// The commands of the paper's listings, in the words of the listings.
namespace tether::tasks {

/// Unit vector in the horizontal plane, counter-clockwise from x.
uav::Vec3 level(double direction_rad);

/// stop(): neither moves nor turns.
Status stop(TaskContext& context);
/// Turns on the spot; counter-clockwise is positive.
Status turn(TaskContext& context, double yaw_rate_rad_s);
/// Turns and keeps a course, as the heading of the moment has it: while the UAV turns, this has to
/// be said again and again.
Status turn_on_course(TaskContext& context, double yaw_rate_rad_s, const Course& course,
                      std::string_view imu);
/// move_direction(): flies level at `speed_m_s` in the direction `direction_rad` from where the
/// nose points (counter-clockwise positive), and does not turn.
Status move_direction(TaskContext& context, double direction_rad, double speed_m_s);

/// Attitude of the body in the reading of an IMU: undoes the IMU's mounting.
uav::Quat attitude(const uav::SensorDescription& imu, const uav::ImuSample& reading);
/// get_yaw(): heading from the newest reading of the IMU, counter-clockwise from east [rad]. Fails
/// (kInvalid) if the UAV has no IMU of that name.
Result<double> get_yaw(TaskContext& context, std::string_view imu);

/// Waits, by the instants of the IMU's readings, until one is `time` younger than the newest of
/// now. Fails (kInvalid) when a thousand readings in a row bring no later instant.
Status pause(TaskContext& context, const std::string& imu, Duration time);

/// A pause after a stop, by the instants of the IMU's readings.
struct Rest {
  Duration settle_time;   ///< while the UAV comes to rest
  Duration measure_time;  ///< while the IMU's bias is measured
};
/// Reads the IMU during `rest`: its bias, and the start of dead reckoning. Ends the task at its
/// limit.
Progress calibrate(TaskContext& context, const std::string& imu, const Rest& rest, LoopLimit& limit,
                   DeadReckoning& reckoning);

/// An image in which an anchor is to be tracked.
struct Shot {
  const uav::SensorDescription& camera;
  vision::AnchorTracker& tracker;  ///< of the anchor
  uav::CameraSample image;
};
/// Reads the next image of the task's camera.
Result<Shot> take_shot(TaskContext& context, const std::string& anchor);
/// Tracks the anchor, and annotates its ROI; none if it is not in the image.
std::optional<vision::Roi> track(TaskContext& context, const Shot& shot);

/// The anchor in one image.
struct Sight {
  SimTime sampled_at;
  vision::RelativePosition position;
};
/// Reads the next image and tracks the anchor in it; none if it is not in the image. Annotates it.
Result<std::optional<Sight>> look(TaskContext& context, const std::string& anchor);

/// Makes a failure of what had not failed before; does nothing if `status` is success.
void fail_on(const Status& status, TaskOutcome& outcome);

}  // namespace tether::tasks
