#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <tether/base/result.h>
#include <tether/base/time.h>
#include <tether/client/vehicle.h>
#include <tether/tasks/mission_tasks.h>
#include <tether/tasks/paper_tasks.h>
#include <tether/tasks/task.h>
#include <tether/tasks/task_context.h>

namespace tether::rig {

using TaskOptions = std::variant<
    tasks::SensorCharacterizationOptions, tasks::RelativePositionOptions, tasks::FaceAnchorOptions,
    tasks::MoveForwardOptions, tasks::ClosedPathOptions, tasks::GoToOptions, tasks::SearchOptions,
    tasks::HoldOptions, tasks::InspectOptions, tasks::LandOptions, tasks::LandOnOptions,
    tasks::SearchPairOptions, tasks::AvoidByScanOptions, tasks::FlyThroughGatesOptions>;

struct TaskSpec {
  TaskOptions options;
  std::string sensor;  ///< of sensor_characterization
  std::string anchor;  ///< of the tasks that look for one
  tasks::VisionOptions vision;

  // In a mission file: see tasks::SequenceItem.
  bool required = true;
  std::string name = {};
  int retry = 0;
  std::optional<std::size_t> otherwise = {};
  std::optional<Duration> within = {}, before = {};
};

/// The tasks of a run.
struct Mission {
  std::vector<TaskSpec> tasks;  ///< at least one
  bool is_sequence = false;  ///< from a mission file; else one task, whose outcome is the mission's
};

/// Reports the outcome to the coordinator. Returns it, or the failure of reporting it. A mission
/// that could not run is not reported; the trial then fails with the program's message.
tasks::TaskOutcome finish(const tasks::TaskOutcome& outcome, client::Vehicle& vehicle);

/// Runs the tasks and finishes.
tasks::TaskOutcome fly(const Mission& mission, client::Vehicle& vehicle);

/// Exit code of the program (docs/design.md section 5): 0 goal reached, 1 not reached, 2 wrong
/// mission, 3 the link was lost.
int exit_code(const tasks::TaskOutcome& outcome);
int exit_code(const Failure& failure);

// Mission files (docs/guide/tasks.md): TOML with a `[[task]]` table for each task, whose keys are
// the options of that task's subcommand with underscores (`--precision-deg` → `precision_deg`),
// and those of mission::task_keys. Clauses are checked, and are otherwise for the host.

/// Reads a mission file. Fails with kInvalid and one line: FILE:LINE and what is wrong.
Result<Mission> load_mission(const std::string& path);
/// The same from the file's text; `path` is for the messages.
Result<Mission> parse_mission(const std::string& text, const std::string& path);

}  // namespace tether::rig
