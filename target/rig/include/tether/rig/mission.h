#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <tether/base/result.h>
#include <tether/base/time.h>
#include <tether/client/vehicle.h>
#include <tether/tasks/mission_tasks.h>
#include <tether/tasks/paper_tasks.h>
#include <tether/tasks/task.h>

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

// The tasks and their arguments as data: the allowed values of each argument, and where its value
// is stored. For the command line ("--precision-deg 2") and mission files ("precision_deg = 2").

struct TextField {
  std::string* value;
  bool is_required = false;
};
struct NumberField {
  double least;
  double most;
  double usual;                     ///< default, in the unit of the argument
  std::function<void(double)> set;  ///< in the same unit
};
struct IntegerField {
  int* value;
  int least;
  int most;
  bool is_odd = false;  ///< even values are not allowed
};
struct BooleanField {
  bool* value;
};
struct ChoiceField {
  std::vector<std::string_view> words;
  std::function<void(std::size_t)> set;  ///< the word's index
};

/// One argument of a task.
struct Field {
  std::string_view name;  ///< as in a file: "precision_deg"
  std::string_view description;
  std::variant<TextField, NumberField, IntegerField, BooleanField, ChoiceField> value;
};

/// A task.
struct TaskKind {
  std::string_view name;         ///< "face_anchor"
  std::string_view description;  ///< one line
  TaskOptions defaults;
};
/// Those of the paper, in its order; then others, to compose missions of.
std::span<const TaskKind> task_kinds();

/// The arguments of the task that `spec.options` holds. They write to `spec`, which must outlive
/// them.
std::vector<Field> fields_of(TaskSpec& spec);
/// The arguments of vision, which all tasks with an anchor have.
std::vector<Field> vision_fields(TaskSpec& spec);

// The row "Real sensor" of the paper's Table II: "compute relative position" on real input.

/// A rectangle of whole pixels, as an image editor selects it.
struct PixelBox {
  double left_px = 0.0;  ///< of its left-most column
  double top_px = 0.0;   ///< of its top row
  double width_px = 0.0;
  double height_px = 0.0;
};

struct RealRowOptions {
  std::optional<PixelBox> true_roi;  ///< of the anchor in the image, as a person annotated it
  std::string keep_image;            ///< file for the image of the last estimate; empty: none
};

struct RealRow {
  /// The outcome of the task, with these additional results if known: "angle_error_deg",
  /// "distance_error_m" (both absolute, as in the paper) and "distance_reference_m".
  tasks::TaskOutcome outcome;
  std::optional<tasks::RelativePositionTask::Sighting> sighting;
  /// Why there is no reference, for a person; one line each.
  std::vector<std::string> notes;
};

/// Runs the task, then measures the distance reference with the catalogue's first rangefinder, if
/// it has one, and compares. The reference does not count as time of the task. Does not `finish`.
/// @pre `spec` is of a relative_position task
RealRow measure_real_row(const TaskSpec& spec, const std::optional<PixelBox>& true_roi,
                         client::Vehicle& vehicle);

/// The row and that of the paper, with "-" for unknown values. `location`: where the SUT ran.
std::string table_2(const RealRow& row, const std::string& location);

/// X,Y,W,H of an estimate's ROI in whole pixels, as in --true-roi-px.
std::string to_pixel_box(const vision::Roi& roi);

}  // namespace tether::rig
