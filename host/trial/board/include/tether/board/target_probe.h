#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tether/board/board.h>
#include <tether/record/messages.h>

/// Reads the state of a machine, with the same script (src/target_probe.sh) here and on a board.
namespace tether::board {

enum class ProbeDepth {
  kBrief,  ///< what can change from run to run; takes some milliseconds
  kFull,   ///< everything; takes more than a second
};

/// Of this machine; empty if its shell does not respond. @throws Error(kSetup) if it cannot be
/// started.
record::Readings probe_here(ProbeDepth depth);
/// Of a board; empty if its shell does not respond or the connection is lost.
record::Readings probe_board(const SshConnection& connection, ProbeDepth depth);

/// Round trip and bandwidth of the connection to a board.
struct Bandwidth {
  double round_trip_s = 0.0;   ///< median, of one byte
  double to_board_MB_s = 0.0;  ///< 10^6 bytes per second, in the direction of images
};

/// Measures the connection over SSH, with encryption. The TCP connection of a run is not slower.
/// None if the board does not respond.
std::optional<Bandwidth> probe_bandwidth(const SshConnection& connection);

// Evaluates the state of a machine (host/trial/board/src/target_probe.sh): what would disturb a
// measurement. Pure functions.

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
