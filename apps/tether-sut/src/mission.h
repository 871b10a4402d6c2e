#pragma once

#include <string>
#include <variant>

#include <tether/client/vehicle.h>
#include <tether/tasks/face_anchor_task.h>
#include <tether/tasks/relative_position_task.h>
#include <tether/tasks/task.h>
#include <tether/vision/anchor_tracker.h>

namespace tether::sut {

/// What the program is asked to fly.
struct Mission {
  std::variant<tasks::FaceAnchorOptions, tasks::ConvergenceOptions> task;
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
