#pragma once

#include <optional>
#include <string>

#include <tether/base/result.h>
#include <tether/calibration/calibration.h>

/// `tether-sut calibrate`: how fast this machine is, and how much slower another one.
namespace tether::calibration {

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
