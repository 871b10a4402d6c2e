#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <tether/record/messages.h>

/// What a machine tells of itself (host/board/src/target_probe.sh), and what of it would spoil a
/// measurement. Pure functions.
namespace tether::board {

enum class Health {
  kOk,
  kWarn,  ///< may disturb, or cannot be told
  kBad,   ///< would spoil a measurement
};
/// "ok", "warn", "bad".
std::string_view name(Health health);

/// One line of a machine's state.
struct Finding {
  std::string subject;  ///< "governor"
  std::string value;    ///< for a person
  Health health = Health::kOk;
  std::string advice;  ///< what it means and what to do; may be empty where all is well
};

/// The "key=value" lines of the probe's output; what is none is passed over.
record::Readings parse_readings(std::string_view text);

/// Judges a machine on which a SUT is to run, in the order of a screen. `version` is that of this
/// program, which the machine's should have. What the machine could not tell is said to be so only
/// where it matters.
std::vector<Finding> judge(const record::Readings& readings, std::string_view version);

/// What the readings around a run say against it.
struct RunWarning {
  std::string text;     ///< one line, naming the reading
  bool spoils = false;  ///< the run's times are not those of the machine as it should be
};
/// On a board everything counts; of the host only that it slowed down.
std::vector<RunWarning> run_warnings(const record::Readings& before, const record::Readings& after,
                                     bool is_board);

}  // namespace tether::board
