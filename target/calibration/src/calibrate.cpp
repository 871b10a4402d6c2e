#include "counted_target.h"
#include "report.h"
#include "statistics.h"
#include "workload.h"

#include <utility>

#include <opencv2/core/version.hpp>

#include <tether/base/result.h>
#include <tether/base/version.h>
#include <tether/calibration/calibration.h>
#include <tether/calibration/characterize.h>
#include <tether/os/machine.h>

namespace tether::calibration {
namespace {

/// As a target file's reader takes it.
constexpr double kLeastFactor = 1e-3, kGreatestFactor = 1e4;

Status check_files(const CalibrateOptions& options) {
  for (const std::string& file : {options.out, options.target}) {
    if (file.empty()) continue;
    if (Status writable = check_writable(file); !writable) return writable;
  }
  return ok_status();
}

Result<Calibration> this_machine(const CalibrateOptions& options, const TellRound& tell) {
  return options.measured.empty() ? measure_machine(options, tell)
                                  : load_calibration(options.measured);
}

/// The name of the machine that was measured, if none is given.
std::string target_name(const CalibrateOptions& options, const Calibration& there) {
  return options.name.empty() ? profile_name_from(there.machine.name) : options.name;
}

/// Writes the target's file, and says so after the table.
Result<std::string> with_target(const std::string& table, const CalibrateOptions& options,
                                const std::string& target) {
  if (const Status written = write_whole(options.target, target); !written)
    return written.failure();
  return table + "\nWritten: " + options.target + "; use it with: tether run SCENARIO --target " +
         options.target + "\n";
}

Result<std::string> compared(const CalibrateOptions& options, const Calibration& here,
                             const Calibration& there) {
  const Result<Comparison> comparison = compare(here, there);
  if (!comparison) return invalid(options.against + ": " + comparison.failure().message);
  std::string text = comparison_table(here, there, *comparison);
  if (options.target.empty()) return text;
  const double factor = comparison->whole.value;
  if (!(factor >= kLeastFactor && factor <= kGreatestFactor)) {
    return invalid("the factor is " + std::to_string(factor) +
                   "; a target's factor must be from 0.001 to 10000");
  }
  return with_target(text, options,
                     target_text(target_name(options, there), here, there, *comparison));
}

Result<std::string> counted(const CalibrateOptions& options, const Calibration& there,
                            const TellRound& tell) {
  const Result<os::Emulator> emulator = emulator_for(options, there.machine);
  if (!emulator) return emulator.failure();
  const Result<Calibration> work = count_work(options, *emulator, tell);
  if (!work) return work.failure();
  const Result<CountedTarget> target = fit_target(*emulator, there, *work);
  if (!target) return invalid(options.against + ": " + target.failure().message);
  const std::string text = prediction_table(*target);
  if (options.target.empty()) return text;
  return with_target(text, options,
                     counted_target_text(target_name(options, there), *target, there, *work));
}

}  // namespace

Status check(const CalibrateOptions& options) {
  if (options.against.empty() && !(options.target.empty() && options.name.empty())) {
    return invalid(
        "--write-target and --name need --against, the measurement of the other machine");
  }
  if (!options.measured.empty() && (options.cpu_index || !options.out.empty())) {
    return invalid("--measured excludes --cpu and --out, which belong to a new measurement");
  }
  const bool has_counting =
      !(options.cpu_model.empty() && options.program.empty() && options.sysroot.empty());
  if (has_counting && !options.counted) {
    return invalid("--cpu-model, --program and --sysroot need --counted");
  }
  if (!options.counted) return ok_status();
  if (options.against.empty()) {
    return invalid(
        "--counted needs --against, the measurement of the machine that is to be predicted");
  }
  if (options.cpu_index || !options.out.empty() || !options.measured.empty()) {
    return invalid(
        "--counted excludes --cpu, --out and --measured, because it measures no time here");
  }
  return ok_status();
}

Result<Calibration> measure_machine(const CalibrateOptions& options, const TellRound& tell) {
  Calibration calibration;
  calibration.machine = read_machine();  // while it still has all its cores
  const Result<int> core = bind_to_core(options.cpu_index);
  if (!core) return core.failure();
  calibration.program = "tether-sut " + std::string(version());
  calibration.opencv = CV_VERSION;
  calibration.when = os::utc_now();
  calibration.machine.cpu_index = *core;
  read_governor(*core, calibration.machine);
  calibration.machine.mhz_before = read_mhz(*core);
  auto measured = run_workload({.rounds = options.rounds}, system_stopwatch(), tell);
  if (!measured) return measured.failure();
  calibration.machine.mhz_after = read_mhz(*core);
  calibration.blocks = std::move(measured->blocks);
  calibration.kernels = std::move(measured->kernels);
  return calibration;
}

Result<std::string> calibrate(const CalibrateOptions& options, const TellRound& tell) {
  if (const Status writable = check_files(options); !writable) return writable.failure();
  std::optional<Calibration> there;
  if (!options.against.empty()) {
    Result<Calibration> loaded = load_calibration(options.against);
    if (!loaded) return loaded.failure();
    there = std::move(loaded).value();
  }
  if (options.counted) return counted(options, *there, tell);
  const Result<Calibration> here = this_machine(options, tell);
  if (!here) return here.failure();
  std::string text = speed_table(*here);
  if (!options.out.empty()) {
    if (const Status written = write_whole(options.out, calibration_text(*here)); !written) {
      return written.failure();
    }
  }
  if (!there) return text;
  const Result<std::string> more = compared(options, *here, *there);
  if (!more) return more.failure();
  return text + "\n" + *more;
}

}  // namespace tether::calibration
