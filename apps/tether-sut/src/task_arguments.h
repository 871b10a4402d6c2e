#pragma once

#include "mission.h"

#include <memory>
#include <string_view>
#include <vector>

namespace CLI {
class App;
}

namespace tether::sut {

/// One task's options as a person writes them, on the command line (`--precision-deg 2`) or in a
/// mission file (`precision_deg = 2`). The tasks' own options hold the defaults.
class TaskArguments {
 public:
  virtual ~TaskArguments() = default;
  virtual std::string_view name() const = 0;         ///< "face_anchor"
  virtual std::string_view description() const = 0;  ///< for --help

  /// Defines the options; once, before `app` parses. They are written to this object, which must
  /// outlive `app`'s parsing.
  virtual void add_to(CLI::App& app) = 0;
  /// What was written, after parsing.
  virtual TaskSpec spec() const = 0;
};

/// A fresh one of each kind of task, in the order of the paper.
std::vector<std::unique_ptr<TaskArguments>> all_task_arguments();
/// A fresh one of this task; nullptr if there is none of this name.
std::unique_ptr<TaskArguments> make_task_arguments(std::string_view task);

}  // namespace tether::sut
