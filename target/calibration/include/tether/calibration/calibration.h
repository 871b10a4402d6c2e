#pragma once

#include <functional>
#include <string>
#include <vector>

#include <tether/base/result.h>

/// How fast a machine computes the paper's vision tasks: the same work, with the same outcome, on
/// any machine (docs/guide/target.md).
namespace tether::calibration {

/// What is measured. Another number is other work, and its times compare with nothing else.
inline constexpr int kWorkloadVersion = 1;

/// With fewer rounds an interval of 95 % would reach beyond what was measured.
inline constexpr int kLeastRounds = 10;

/// Told what begins: "round 3 of 30".
using TellRound = std::function<void(const std::string&)>;

/// The times of one building block, one of each round, per image.
struct BlockTimes {
  std::string name;
  std::vector<double> cpu_ms;   ///< CPU time of this process
  std::vector<double> wall_ms;  ///< as long
};

/// A machine as it shows itself to a program without rights. Empty or 0: it does not tell.
struct Machine {
  std::string name;          ///< of the host
  std::string cpu;           ///< model
  std::string architecture;  ///< "x86_64", "aarch64"
  int cores = 0;             ///< that this process may use
  int cpu_index = -1;        ///< on which was measured; -1: any
  std::string governor;      ///< of that one
  double mhz_before = 0.0;
  double mhz_after = 0.0;
};

/// One machine's measurement.
struct Calibration {
  int workload = kWorkloadVersion;
  std::string program;  ///< "tether-sut 0.1.0"
  std::string opencv;   ///< version
  std::string when;     ///< "2025-03-01T12:00:00Z"
  Machine machine;
  std::vector<BlockTimes> blocks;  ///< in the order of the work; all of as many rounds
};

/// The block that is all of the others in one: what a task does with an image.
inline constexpr const char* kWholeStep = "perception";

/// As a file (TOML), whatever bytes the texts have.
std::string calibration_text(const Calibration& calibration);

/// Fails (kInvalid) with one line that names file and line: no valid TOML, a key that is missing or
/// wrong, other work than this program's, a time that is not positive, blocks that differ in their
/// number of rounds.
Result<Calibration> parse_calibration(const std::string& text, const std::string& path);
Result<Calibration> load_calibration(const std::string& path);

}  // namespace tether::calibration
