#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <tether/base/result.h>

/// How fast a machine computes the paper's vision tasks: the same work with the same results on
/// every machine (docs/guide/target.md).
namespace tether::calibration {

/// Version of the measured work. Times of different versions cannot be compared.
inline constexpr int kWorkloadVersion = 1;

/// With fewer rounds, a 95 % interval would extend beyond the measured values.
inline constexpr int kLeastRounds = 10;

/// Receives each step as it begins: "round 3 of 30".
using TellRound = std::function<void(const std::string&)>;

/// The times of one building block per image, one for each round.
struct BlockTimes {
  std::string name;
  std::vector<double> cpu_ms;   ///< CPU time of this process
  std::vector<double> wall_ms;  ///< of the same length
  /// Under an emulator with Tether's plugin: how often each kind of work is done per image, in the
  /// order of WorkClass; else empty.
  std::vector<double> work{};
};

/// What an unprivileged program can read about a machine. Empty or 0: unknown.
struct Machine {
  std::string name;          ///< of the host
  std::string cpu;           ///< model
  std::string architecture;  ///< "x86_64", "aarch64"
  int cores = 0;             ///< available to this process
  int cpu_index = -1;        ///< the measured core; -1: any
  std::string governor;      ///< of that core
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
  std::vector<BlockTimes> blocks;  ///< in the order of the work; with equal numbers of rounds
  /// Short loops, each mostly of one kind of work; empty: an older program measured. An "image" is
  /// one run of the loop.
  std::vector<BlockTimes> kernels{};
};

/// The block that consists of all others: what a task does with an image.
inline constexpr const char* kWholeStep = "perception";

/// The TOML file of a measurement. Texts can contain any bytes.
std::string calibration_text(const Calibration& calibration);

/// Reads a measurement. Fails with kInvalid and one line (FILE:LINE and what is wrong) for invalid
/// TOML, a missing or wrong key, another version of the work, a time that is not positive, and
/// blocks with different numbers of rounds.
Result<Calibration> parse_calibration(const std::string& text, const std::string& path);
Result<Calibration> load_calibration(const std::string& path);

// The machine that this program runs on, from /proc and /sys, and its clock.

/// The host's name; "unknown host" if it is not known.
std::string host_name();

/// `root` contains /proc and /sys; only tests set it. Frequencies stay 0.
Machine read_machine(const std::string& root = "");

/// Clock rate of a core [MHz]; 0: unknown.
double read_mhz(int cpu_index, const std::string& root = "");

/// Binds this process to the given core, or to the last one available. Returns the core. Fails with
/// kInvalid if the core is not available.
Result<int> bind_to_core(std::optional<int> cpu_index);

/// Reads the governor of that core into `machine`.
void read_governor(int cpu_index, Machine& machine, const std::string& root = "");

// `tether-sut calibrate`: how fast this machine is, and how much slower another one.

struct CalibrateOptions {
  int rounds = 30;
  std::optional<int> cpu_index;  ///< the core to measure on; none: the last allowed
  std::string out;               ///< the measurement's file; empty: none
  std::string measured;          ///< a measurement of this machine, instead of making one
  std::string against;           ///< a measurement of another machine; empty: none
  std::string target;            ///< the virtual target's file; empty: none
  std::string name;              ///< of the target; empty: that machine's
  /// The target counts work instead of measuring CPU time: its costs are fitted to the other
  /// machine's times.
  bool counted = false;
  std::string
      cpu_model;  ///< with `counted`: for the emulator; empty: one that suits its architecture
  std::string program;  ///< with `counted`: this program for the other machine; empty: itself
  std::string sysroot;  ///< with `counted`: the folder of its libraries; empty: those of here
};

/// Checks options that depend on each other. Fails with kInvalid and one line.
Status check(const CalibrateOptions& options);

/// Measures this machine, on one core and one thread. Fails with kInvalid if the core is not
/// available, or if this machine computes other results than expected.
Result<Calibration> measure_machine(const CalibrateOptions& options, const TellRound& tell = {});

/// Reads files, measures, writes files, and returns the text to print. Checks all files before it
/// measures. Fails with kInvalid and one line.
Result<std::string> calibrate(const CalibrateOptions& options, const TellRound& tell = {});

}  // namespace tether::calibration
