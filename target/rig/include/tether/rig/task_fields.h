#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <tether/rig/mission.h>

/// The tasks and their arguments as data: the allowed values of each argument, and where its value
/// is stored. For the command line ("--precision-deg 2") and mission files ("precision_deg = 2").
namespace tether::rig {

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

}  // namespace tether::rig
