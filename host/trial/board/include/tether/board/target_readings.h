#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tether/record/messages.h>

/// Evaluates the state of a machine (host/trial/board/src/target_probe.sh): what would disturb a
/// measurement. Pure functions.
namespace tether::board {

enum class Health {
  kOk,
  kWarn,  ///< may disturb a measurement, or is unknown
  kBad,   ///< would disturb a measurement
};
/// "ok", "warn", "bad".
std::string_view name(Health health);

/// One property of a machine.
struct Finding {
  std::string subject;  ///< "governor"
  std::string value;    ///< for a person
  Health health = Health::kOk;
  std::string advice;  ///< what it means and what to do; may be empty if it is ok
};

/// Parses the probe's output: "key=value" lines. Other lines are ignored.
record::Readings parse_readings(std::string_view text);

/// Evaluates a machine on which a SUT will run, in the order of display. `version` is that of this
/// program; the machine should have the same. Missing readings are findings only if they matter.
std::vector<Finding> evaluate(const record::Readings& readings, std::string_view version);

/// A change of the machine's state that affected a run.
struct RunWarning {
  std::string text;     ///< one line, naming the reading
  bool spoils = false;  ///< the times of the run are not valid
};
/// For which share of a run programs waited for a processor of the machine, because others had it
/// or because the SUT has more threads than there are; or, if that is more, other virtual machines
/// had one. None: not known.
std::optional<double> contended_share(const record::Readings& before,
                                      const record::Readings& after);

/// Compares the readings before and after a run. For the host, checks only whether it was
/// throttled.
std::vector<RunWarning> run_warnings(const record::Readings& before, const record::Readings& after,
                                     bool is_board);

}  // namespace tether::board
