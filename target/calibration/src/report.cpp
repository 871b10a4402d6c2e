#include "report.h"

#include <algorithm>
#include <limits>

#include <tether/base/text.h>
#include <tether/calibration/characterize.h>

// The tables and the target file of `tether-sut calibrate`: one machine's speed, the comparison of
// two, and the doubts about both.
namespace tether::calibration {
namespace {

/// Three significant digits or so, for factors.
std::string in_words(double factor) {
  return fixed(factor, factor < 1.0 ? 3 : factor < 100.0 ? 2 : 0);
}

std::string in_words(const Interval& interval) {
  return in_words(interval.low) + " to " + in_words(interval.high);
}

std::string with_interval(const Factor& factor) {
  return in_words(factor.value) + " (" + in_words(factor.interval) + ")";
}

std::string percent(double share) {
  return fixed(100.0 * share, share < 0.1 ? 1 : 0) + " %";
}

/// From microseconds to seconds.
std::string ms_text(double ms) {
  return fixed(ms, ms < 0.1 ? 5 : 3);
}

std::vector<std::string> speed_row(const BlockTimes& block) {
  const Quartiles cpu = quartiles(block.cpu_ms), wall = quartiles(block.wall_ms);
  return {block.name,
          std::to_string(block.cpu_ms.size()),
          ms_text(cpu.median),
          percent(cpu.spread()),
          ms_text(wall.median),
          percent(wall.spread()),
          fixed(1e3 / cpu.median, cpu.median < 1.0 ? 0 : 1)};
}

std::string core_line(const Machine& machine) {
  std::string text = "core " + std::to_string(machine.cpu_index) + " of " +
                     std::to_string(machine.cores) + "; governor " +
                     (machine.governor.empty() ? "unknown" : plain(machine.governor));
  if (machine.mhz_before > 0.0 && machine.mhz_after > 0.0) {
    text += "; " + fixed(machine.mhz_before, 0) + " MHz before, " + fixed(machine.mhz_after, 0) +
            " MHz after";
  } else {
    text += "; clock rate unknown";
  }
  return text;
}

/// Each in a line of its own, after `begin`; without those that `told` has.
std::string doubts_text(const Calibration& calibration, const std::string& begin = "",
                        const std::string& told = "") {
  std::string text;
  for (const std::string& doubt : doubts(calibration)) {
    const std::string line =
        begin + "Doubtful on " + machine_line(calibration.machine) + ": " + doubt + ".\n";
    if (told.find(line) == std::string::npos) text += line;
  }
  return text;
}

/// How far a single factor is off for the block that suits it least: of `factor`, above or below.
double worst_miss(const Comparison& comparison, double factor) {
  const double above = comparison.greatest().value / factor,
               below = factor / comparison.least().value;
  return std::max(above, below) - 1.0;
}

/// Whether one factor lies within the intervals of all blocks, the whole step's as well.
bool do_agree(const Comparison& comparison) {
  double low = 0.0, high = std::numeric_limits<double>::infinity();
  for (const Factor& factor : comparison.blocks) {
    low = std::max(low, factor.interval.low);
    high = std::min(high, factor.interval.high);
  }
  return low <= high;
}

std::string agreement_text(const Comparison& comparison) {
  const std::string single = in_words(comparison.whole.value);
  if (do_agree(comparison)) {
    return "Blocks agree within their intervals: a single factor of " + single +
           " is right for each.\n";
  }
  const Factor &least = comparison.least(), &greatest = comparison.greatest();
  return "Blocks disagree: from " + in_words(least.value) + " (" + least.block + ") to " +
         in_words(greatest.value) + " (" + greatest.block + "). A single factor of " + single +
         " is right for " + kWholeStep + ", and off by up to " +
         percent(worst_miss(comparison, comparison.whole.value)) + " for one of its blocks.\n";
}

}  // namespace

std::string machine_line(const Machine& machine) {
  return plain(machine.name) + " (" + (machine.cpu.empty() ? "" : plain(machine.cpu) + ", ") +
         plain(machine.architecture) + ")";
}

std::string speed_table(const Calibration& calibration) {
  std::vector<std::vector<std::string>> rows = {
      {"block", "rounds", "CPU [ms]", "spread", "wall [ms]", "spread", "per CPU second"}};
  for (const BlockTimes& block : calibration.blocks) rows.push_back(speed_row(block));
  return machine_line(calibration.machine) + ", " + plain(calibration.when) + "\n" +
         core_line(calibration.machine) + "\n\n" + text_table(rows) +
         "Medians per image of 640 x 480 pixels; spread: distance of the quartiles.\n" +
         doubts_text(calibration);
}

std::string comparison_table(const Calibration& here, const Calibration& there,
                             const Comparison& comparison) {
  std::vector<std::vector<std::string>> rows = {{"block", "", "times longer", "95 % interval"}};
  for (const Factor& factor : comparison.blocks) {
    rows.push_back({factor.block, "", in_words(factor.value), in_words(factor.interval)});
  }
  rows.push_back({"geometric mean", "", in_words(comparison.overall.value),
                  in_words(comparison.overall.interval)});
  return "CPU time on " + machine_line(there.machine) + "\nagainst " + machine_line(here.machine) +
         "\n\n" + text_table(rows) + "The geometric mean leaves out " + kWholeStep +
         ", which contains the other blocks.\n" + doubts_text(there, "", doubts_text(here)) +
         agreement_text(comparison);
}

std::string target_text(const std::string& name, const Calibration& here, const Calibration& there,
                        const Comparison& comparison) {
  const std::string what = machine_line(there.machine) + " as measured on " + plain(there.when) +
                           ": vision takes " + with_interval(comparison.whole) +
                           " times the CPU time of " + machine_line(here.machine);
  std::string text = "# Calibrated by " + plain(here.program) + ", " + plain(here.when) + ".\n#\n";
  text += "# " + machine_line(there.machine) + ",\n#   " + plain(there.program) + ", OpenCV " +
          plain(there.opencv) + ", " + core_line(there.machine) + ";\n";
  text += "# against " + machine_line(here.machine) + ",\n#   " + plain(here.program) +
          ", OpenCV " + plain(here.opencv) + ", " + core_line(here.machine) + ".\n#\n";
  text += "# Seconds of CPU time there for one here, with the 95 % interval:\n";
  for (const Factor& factor : comparison.blocks) {
    text += "#   " + factor.block + " " + with_interval(factor) + "\n";
  }
  text += "#   geometric mean " + with_interval(comparison.overall) + "\n";
  text += doubts_text(there, "# ") + doubts_text(here, "# ", doubts_text(there, "# "));
  text += "# It stands in for that machine on this host only, and for other work than " +
          std::string(kWholeStep) + "\n# no better than the blocks agree.\n";
  return text + "name = " + toml_string(name) + "\ndescription = " + toml_string(what) +
         "\nclock = \"cpu\"\ncpu_factor = " + fixed(comparison.whole.value, 4) +
         "\ncpu_factor_interval = [" + fixed(comparison.whole.interval.low, 4) + ", " +
         fixed(comparison.whole.interval.high, 4) + "]\n";
}

}  // namespace tether::calibration
