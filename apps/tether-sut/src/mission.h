#pragma once

#include <string>
#include <variant>
#include <vector>

#include <tether/client/vehicle.h>
#include <tether/tasks/closed_path_task.h>
#include <tether/tasks/face_anchor_task.h>
#include <tether/tasks/move_forward_task.h>
#include <tether/tasks/relative_position_task.h>
#include <tether/tasks/task.h>
#include <tether/vision/anchor_tracker.h>

namespace tether::sut {

using TaskOptions = std::variant<tasks::RelativePositionOptions, tasks::FaceAnchorOptions,
                                 tasks::MoveForwardOptions, tasks::ClosedPathOptions>;

/// What the program is asked to fly.
struct Mission {
  TaskOptions task;
  std::string anchor;
  std::string camera = "camera";
  vision::TrackerOptions tracker;
};

/// Runs the task and tells the coordinator how it ended.
tasks::TaskOutcome fly(const Mission& mission, client::Vehicle& vehicle);

/// Exit code of the program (DESIGN section 5): 0 reached, 1 not reached, 2 the mission cannot be
/// flown as asked for, 3 the link is gone.
int exit_code(const tasks::TaskOutcome& outcome);
int exit_code(const Failure& failure);

}  // namespace tether::sut
