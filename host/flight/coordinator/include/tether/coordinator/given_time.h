#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tether/link/messages.h>

namespace tether::coordinator {

/// Gives one SUT its time, by stage, with the clock "replayed". What it gives depends on the calls
/// so far only. Not thread-safe; used by the thread of Coordinator::run.
class GivenTime {
 public:
  virtual ~GivenTime() = default;

  /// What is different between this program and the one whose time it is; none: nothing. Called
  /// before the SUT is welcomed.
  virtual std::optional<std::string> other_build(const link::Hello& hello) const = 0;
  /// What each stage takes until the next call.
  virtual std::vector<link::StageTime> given() const = 0;
  /// Takes the next call of the SUT: a kind of record::Interaction, or the name of a sensor; and
  /// the stages before it. The difference to what was given, which ends the run; none if there is
  /// none.
  virtual std::optional<std::string> take(const std::string& call,
                                          const std::vector<link::StageTime>& stages) = 0;
  /// Whether the time of that stage is known.
  virtual bool knows(const std::string& stage) const = 0;
};

}  // namespace tether::coordinator
