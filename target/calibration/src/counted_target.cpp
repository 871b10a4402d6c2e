#include "counted_target.h"

#include "kernels.h"
#include "report.h"
#include "statistics.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include <tether/base/text.h>
#include <tether/calibration/characterize.h>
#include <tether/os/child_process.h>
#include <tether/os/text_file.h>
#include <tether/toml/table.h>

namespace tether::calibration {
namespace {

// Enough for the work of one round to be known; more would give the same counts.
constexpr const char* kCountedRounds = "10";
// The kernels only tell apart what the blocks of real work leave open: their loops use a core
// better than most programs do.
constexpr double kWeightOfKernels = 0.05;
constexpr Duration kLongestCount = std::chrono::minutes(30);
constexpr Duration kLook = std::chrono::milliseconds(200);

// How many pieces of each kind of work the widest cores begin in a cycle: eight in all, and as many
// as they have units for that kind.
constexpr Costs_ns kMostPerCycle = {8, 2, 1, 8, 8, 8, 4, 4, 4, 1};

struct EmulatedMachine {
  const char* architecture;
  const char* emulator;
  const char* cpu_model;
};
/// A model that the emulator imitates well, and whose instructions every such machine has.
constexpr EmulatedMachine kMachines[] = {{"x86_64", "qemu-x86_64", "Nehalem"},
                                         {"aarch64", "qemu-aarch64", "cortex-a72"}};

/// @throws Error
Calibration counted_by(const CalibrateOptions& options, const os::Emulator& emulator,
                       const TellRound& tell) {
  const os::TemporaryFolder folder("tether-count-");
  const auto out = folder / "counts.toml", log = folder / "log";
  const std::string program = options.program.empty()
                                  ? os::own_file().string()
                                  : std::filesystem::absolute(options.program).string();
  os::CountFile counts(emulator);
  os::ChildCommand command{.arguments = {os::find_emulator(emulator).string(), program, "calibrate",
                                         "--rounds", kCountedRounds, "--out", out.string()},
                           .environment = counts.environment(),
                           .log = log};
  os::pad_start(command);
  os::ChildProcess child(command);
  if (tell) tell("counting under " + emulator.program);
  const auto end = std::chrono::steady_clock::now() + kLongestCount;
  while (!child.wait(kLook))
    if (std::chrono::steady_clock::now() > end)
      throw Error(ErrorCode::kSetup, program + " did not end under " + emulator.program);
  if (child.poll()->code != 0)
    throw Error(ErrorCode::kSetup, program + " under " + emulator.program + " " +
                                       child.poll()->description +
                                       "; its last line: " + os::last_line(os::read_file(log)));
  Result<Calibration> counted = load_calibration(out.string());
  if (!counted) throw Error(ErrorCode::kBadFile, counted.failure().message);
  return std::move(counted).value();
}

const BlockTimes* find(const std::vector<BlockTimes>& blocks, const std::string& name) {
  const auto found = std::find_if(blocks.begin(), blocks.end(),
                                  [&](const BlockTimes& block) { return block.name == name; });
  return found == blocks.end() ? nullptr : &*found;
}

Failure not_measured(const std::string& block) {
  return invalid("the block \"" + block +
                 "\" was not measured there. Measure that machine again with the same tether-sut");
}

Result<std::vector<CountedBlock>> paired(const std::vector<BlockTimes>& measured,
                                         const std::vector<BlockTimes>& counted) {
  std::vector<CountedBlock> pairs;
  for (const BlockTimes& block : counted) {
    const BlockTimes* times = find(measured, block.name);
    if (!times || block.work.size() != kWorkClasses) return not_measured(block.name);
    CountedBlock pair{.name = block.name, .time_ns = 1e6 * quartiles(times->cpu_ms).median};
    std::copy(block.work.begin(), block.work.end(), pair.work.begin());
    pairs.push_back(std::move(pair));
  }
  return pairs;
}

/// What work costs at least on the machine with these kernels; none: it is not known.
std::optional<Costs_ns> floor_of(const std::vector<BlockTimes>& kernels) {
  const BlockTimes* const chain = find(kernels, kChain);
  if (!chain) return std::nullopt;
  const double cycle_ns = 1e6 * quartiles(chain->cpu_ms).median / kCyclesOfChain;
  Costs_ns floor_ns{};
  for (std::size_t kind = 0; kind < kWorkClasses; ++kind)
    floor_ns[kind] = cycle_ns / kMostPerCycle[kind];
  return floor_ns;
}

/// Which costs the times do not determine.
std::string bounds_text(const CountedTarget& target) {
  std::string bounded;
  for (std::size_t kind = 0; kind < kWorkClasses; ++kind)
    if (target.costs[kind] <= target.floor_ns[kind])
      bounded += (bounded.empty() ? "" : ", ") + std::string(kWorkClassNames[kind]);
  const double cycle_ns = target.floor_ns[0] * kMostPerCycle[0];
  return "A cycle is " + fixed(cycle_ns, 3) + " ns (block " + kChain +
         "). No cost is below what the widest cores need: an eighth of a\n"
         "cycle, a quarter for floating-point and vector work, half for a multiplication, and one "
         "cycle for\na division or an atomic operation.\n" +
         (bounded.empty()
              ? "No cost is at this bound.\n"
              : "At this bound, because the blocks do not show more: " + bounded + ".\n");
}

std::string signed_percent(double share) {
  return (share < 0.0 ? "" : "+") + fixed(100.0 * share, 1) + " %";
}

std::vector<std::string> row(const CountedTarget& target, const CountedBlock& block) {
  return {block.name, fixed(1e-6 * block.time_ns, 5),
          fixed(1e-6 * predicted_ns(target.costs, block), 5),
          signed_percent(relative_error(target.costs, block))};
}

constexpr const char* kWhatIsNotKnown =
    "The costs are averages over this work. They do not represent cache misses, memory bandwidth,\n"
    "changes of the clock rate, and chains of operations that wait for each other.\n";

}  // namespace

Result<os::Emulator> emulator_for(const CalibrateOptions& options, const Machine& there) {
  for (const EmulatedMachine& machine : kMachines)
    if (there.architecture == machine.architecture)
      return os::Emulator{
          .program = machine.emulator,
          .cpu_model = options.cpu_model.empty() ? machine.cpu_model : options.cpu_model,
          .sysroot = options.sysroot.empty()
                         ? ""
                         : std::filesystem::absolute(options.sysroot).lexically_normal().string()};
  return invalid(options.against + ": no program for \"" + plain(there.architecture) +
                 "\" can be counted, only for x86_64 and aarch64");
}

Result<Calibration> count_work(const CalibrateOptions& options, const os::Emulator& emulator,
                               const TellRound& tell) {
  return toml::result_of([&] { return counted_by(options, emulator, tell); });
}

Result<CountedTarget> fit_target(const os::Emulator& emulator, const Calibration& there,
                                 const Calibration& counted) {
  CountedTarget target{.emulator = emulator, .blocks = {}, .left_out = {}, .whole = {}};
  const auto floor_ns = floor_of(there.kernels);
  if (!floor_ns) return not_measured(kChain);
  target.floor_ns = *floor_ns;
  for (const auto& [measured, work] :
       {std::pair(&there.blocks, &counted.blocks), std::pair(&there.kernels, &counted.kernels)}) {
    Result<std::vector<CountedBlock>> pairs = paired(*measured, *work);
    if (!pairs) return pairs.failure();
    if (measured == &there.kernels)
      for (CountedBlock& pair : *pairs) pair.weight = kWeightOfKernels;
    target.blocks.insert(target.blocks.end(), pairs->begin(), pairs->end());
  }
  const auto whole = std::find_if(target.blocks.begin(), target.blocks.end(),
                                  [](const CountedBlock& b) { return b.name == kWholeStep; });
  if (whole == target.blocks.end())
    return invalid("the block \"" + std::string(kWholeStep) + "\" was not counted");
  target.whole = *whole;
  target.blocks.erase(whole);
  target.costs = fit_costs(target.blocks, target.floor_ns);
  target.left_out = errors_when_left_out(target.blocks, target.floor_ns);
  return target;
}

std::string prediction_table(const CountedTarget& target) {
  std::vector<std::vector<std::string>> rows = {
      {"block", "measured [ms]", "predicted [ms]", "error", "left out"}};
  for (std::size_t i = 0; i < target.blocks.size(); ++i) {
    rows.push_back(row(target, target.blocks[i]));
    rows.back().push_back(signed_percent(target.left_out[i]));
  }
  rows.push_back(row(target, target.whole));
  rows.back().emplace_back("not in the fit");
  return text_table(rows) +
         "Left out: the error of the prediction by a fit to the other blocks.\n" +
         bounds_text(target) + kWhatIsNotKnown;
}

std::string counted_target_text(const std::string& name, const CountedTarget& target,
                                const Calibration& there, const Calibration& counted) {
  const os::Emulator& emulator = target.emulator;
  std::string comment = "Costs of " + machine_line(there.machine) + ", measured by " +
                        plain(there.program) + ", " + plain(there.when) + ";\ncounted by " +
                        plain(counted.program) + " under " + emulator.program + ", " +
                        plain(counted.when) + ".\n\n" + prediction_table(target);
  std::string text = "# ";
  for (std::size_t i = 0; i + 1 < comment.size(); ++i) {
    text += comment[i];
    if (comment[i] == '\n') text += comment[i + 1] == '\n' ? "#" : "# ";
  }
  text += "\nname = " + toml_string(name) +
          "\ndescription = " + toml_string(machine_line(there.machine) + ", by counted work") +
          "\nclock = \"counted\"\nemulator = " + toml_string(emulator.program) +
          "\ncpu_model = " + toml_string(emulator.cpu_model) + "\n";
  if (!emulator.sysroot.empty()) text += "sysroot = " + toml_string(emulator.sysroot) + "\n";
  text += "\n# Nanoseconds for each piece of work.\n[cost_ns]\n";
  for (std::size_t kind = 0; kind < kWorkClasses; ++kind)
    text += std::string(kWorkClassNames[kind]) + " = " + fixed(target.costs[kind], 5) + "\n";
  return text;
}

}  // namespace tether::calibration
