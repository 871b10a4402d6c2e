#pragma once

#include <string>
#include <variant>
#include <vector>

#include <tether/client/vehicle.h>
#include <tether/tasks/closed_path_task.h>
#include <tether/tasks/face_anchor_task.h>
#include <tether/tasks/move_forward_task.h>
#include <tether/tasks/relative_position_task.h>
#include <tether/tasks/sensor_characterization_task.h>
#include <tether/tasks/task.h>
#include <tether/tasks/task_context.h>

namespace tether::rig {

using TaskOptions =
    std::variant<tasks::SensorCharacterizationOptions, tasks::RelativePositionOptions,
                 tasks::FaceAnchorOptions, tasks::MoveForwardOptions, tasks::ClosedPathOptions>;

struct TaskSpec {
  TaskOptions options;
  std::string sensor;  ///< that sensor_characterization is about
  std::string anchor;  ///< that the others are about
  tasks::VisionOptions vision;
  bool required = true;  ///< of a mission file's: see tasks::SequenceItem
};

/// What the program is asked to fly.
struct Mission {
  std::vector<TaskSpec> tasks;  ///< at least one
  bool is_sequence = false;  ///< from a mission file; else one task, whose outcome is the mission's
};

/// Tells the coordinator how it ended; returns that, or that it could not be told. Of what could
/// not run it tells nothing: that is no result, and the trial fails with the program's own words.
tasks::TaskOutcome finish(const tasks::TaskOutcome& outcome, client::Vehicle& vehicle);

/// Runs the tasks and finishes.
tasks::TaskOutcome fly(const Mission& mission, client::Vehicle& vehicle);

/// Exit code of the program (DESIGN section 5): 0 reached, 1 not reached, 2 the mission cannot be
/// flown as asked for, 3 the link is gone.
int exit_code(const tasks::TaskOutcome& outcome);
int exit_code(const Failure& failure);

}  // namespace tether::rig
