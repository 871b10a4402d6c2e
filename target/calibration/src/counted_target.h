#pragma once

#include "cost_fit.h"

#include <string>
#include <vector>

#include <tether/calibration/calibration.h>
#include <tether/os/counted_program.h>

/// A target whose SUTs' work is counted, with the costs of a machine that was measured.
namespace tether::calibration {

/// Costs, and how well they predict.
struct CountedTarget {
  os::Emulator emulator;  ///< without costs
  Costs_ns costs{};
  Costs_ns floor_ns{};               ///< no cost is less
  std::vector<CountedBlock> blocks;  ///< of the fit
  std::vector<double> left_out;      ///< error of each, by a fit to the others
  CountedBlock whole;                ///< the whole step, which is not in the fit
};

/// The emulator for a machine's programs. Fails (kInvalid) with one line if there is none.
Result<os::Emulator> emulator_for(const CalibrateOptions& options, const Machine& there);

/// Runs `calibrate` of the other machine's program under the emulator, and reads what was counted.
/// Fails (kInvalid) with one line.
Result<Calibration> count_work(const CalibrateOptions& options, const os::Emulator& emulator,
                               const TellRound& tell);

/// Fits the costs to `there`'s times of the work in `counted`. No kind of work costs less than on
/// the widest cores at the clock rate that `kChain` shows. Fails (kInvalid) with one line if
/// they have different blocks, or an older program measured.
Result<CountedTarget> fit_target(const os::Emulator& emulator, const Calibration& there,
                                 const Calibration& counted);

/// For people: each block's time, its prediction, and the errors.
std::string prediction_table(const CountedTarget& target);
/// The target's file. @pre is_profile_name(name)
std::string counted_target_text(const std::string& name, const CountedTarget& target,
                                const Calibration& there, const Calibration& counted);

}  // namespace tether::calibration
