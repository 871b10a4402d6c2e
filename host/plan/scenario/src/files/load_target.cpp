#include "tables/read_clock.h"
#include "tables/read_power.h"

#include <array>
#include <cmath>

#include <fmt/format.h>

#include <tether/scenario/scenario.h>
#include <tether/scenario/target.h>
#include <tether/toml/table.h>

namespace tether::scenario {
namespace {

constexpr std::array<std::string_view, 2> kEmulators = {"qemu-aarch64", "qemu-x86_64"};
constexpr std::int64_t kMostCores = 4096;

std::optional<SshAddress> read_address(const toml::Table& root) {
  if (!root.has("address")) return std::nullopt;
  const std::string address = root.text("address");
  try {
    return parse_ssh_address(address);
  } catch (const Error& error) {
    root.fail("address", fmt::format("is \"{}\"; {}", address, error.what()));
  }
}

/// A board is measured, not slowed down, and uses all of its cores.
void reject_keys_of_virtual_targets(const toml::Table& root, const Target& target) {
  if (target.clock.kind != computer::ClockKind::kWall) {
    root.fail("clock",
              fmt::format("is \"{}\", but a target with an address needs the clock \"wall\".",
                          computer::name(target.clock.kind)));
  }
  for (const char* key : {"cpu_factor", "cpu_factor_interval", "cores"}) {
    if (root.has(key))
      root.fail(key, "is for targets on this host. Remove this key, or 'address'.");
  }
}

std::string beside(const Target& target, const std::string& path) {
  return (target.file.parent_path() / path).lexically_normal().string();
}

/// Words that begin with "./" or "../" are files beside the target's, as in `-L ../sysroot`.
std::vector<std::string> read_launcher(const toml::Table& root, const Target& target) {
  std::vector<std::string> words = root.texts_or_none("launcher");
  if (root.has("launcher") && words.empty()) {
    root.fail("launcher", "is empty. Name a program.");
  }
  for (std::string& word : words) {
    const bool is_relative = word.starts_with("./") || word.starts_with("../");
    if (is_relative && !target.ssh) word = beside(target, word);
  }
  return words;
}

void read_interval(const toml::Table& root, const toml::Range& range, Target& target) {
  const std::vector<double> bounds = root.numbers("cpu_factor_interval", 2, range);
  if (bounds[0] > target.clock.factor || bounds[1] < target.clock.factor)
    root.fail("cpu_factor_interval",
              fmt::format("is [{}, {}], which does not contain cpu_factor = {}.", bounds[0],
                          bounds[1], target.clock.factor));
  target.cpu_factor_interval = {bounds[0], bounds[1]};
}

/// On a board, the folder is checked when a run starts. On this host it need not exist yet: the
/// programs may be built after the file is written.
std::string read_program_folder(const toml::Table& root, const Target& target) {
  const std::string folder = root.text_or("program_folder", "");
  return folder.empty() || target.ssh ? folder : beside(target, folder);
}

std::array<std::uint64_t, kWorkClasses> read_costs(const toml::Table& root) {
  constexpr double kLeast_ns = 1e-3, kMost_ns = 1e4;
  if (!root.has("cost_ns"))
    root.fail("cost_ns", "is missing. The clock \"counted\" needs the table [cost_ns].");
  std::vector<std::string_view> keys;
  for (const char* key : kWorkClassNames) keys.emplace_back(key);
  const toml::Table table = root.table("cost_ns", keys);
  std::array<std::uint64_t, kWorkClasses> units{};
  for (std::size_t kind = 0; kind < kWorkClasses; ++kind) {
    const double cost_ns = table.number(keys[kind], {.min = 0.0, .max = kMost_ns});
    if (cost_ns < kLeast_ns)
      table.fail(keys[kind],
                 fmt::format("is {} ns, so that this work would take no time. The least cost is {} "
                             "ns; `tether-sut calibrate --counted` finds costs of a machine.",
                             cost_ns, kLeast_ns));
    units[kind] =
        static_cast<std::uint64_t>(std::llround(cost_ns * static_cast<double>(kCostUnitsPerNs)));
  }
  return units;
}

/// What the clock "counted" needs, and no other clock has.
std::optional<os::Emulator> read_emulator(const toml::Table& root, const Target& target) {
  if (target.clock.kind != computer::ClockKind::kCounted) {
    for (const char* key : {"emulator", "cpu_model", "sysroot", "cost_ns"})
      if (root.has(key)) root.fail(key, "needs clock = \"counted\".");
    return std::nullopt;
  }
  for (const char* key : {"cpu_factor", "launcher"})
    if (root.has(key))
      root.fail(key, "cannot be used with the clock \"counted\". Remove this key.");
  os::Emulator emulator;
  emulator.program = kEmulators[root.choice("emulator", kEmulators)];
  emulator.cpu_model = root.text("cpu_model");
  if (root.has("sysroot")) emulator.sysroot = beside(target, root.text("sysroot"));
  emulator.cost_units = read_costs(root);
  return emulator;
}

}  // namespace

Target load_target(const std::filesystem::path& file) {
  constexpr toml::Range kFactor{.min = 1e-3, .max = 1e4};
  Target target;
  target.file = std::filesystem::absolute(file).lexically_normal();
  const toml::Document document = toml::Document::load(target.file);
  const toml::Table root = document.root(
      {"name", "description", "address", "clock", "cpu_factor", "cpu_factor_interval", "cores",
       "launcher", "program_folder", "emulator", "cpu_model", "sysroot", "cost_ns", "power"});
  target.name = root.identifier("name");
  if (slug(target.name).empty()) {
    root.fail("name", "must contain a letter or a digit, because it becomes the name of a folder.");
  }
  target.description = root.text_or("description", "");
  target.ssh = read_address(root);
  if (root.has("clock"))
    target.clock.kind = read_clock_kind(
        root,
        {computer::ClockKind::kWall, computer::ClockKind::kCpu, computer::ClockKind::kCounted});
  if (target.ssh) reject_keys_of_virtual_targets(root, target);
  target.clock.factor = root.number_or("cpu_factor", kFactor, 1.0);
  if (root.has("cpu_factor_interval")) read_interval(root, kFactor, target);
  target.cores = static_cast<int>(root.integer_or("cores", 1, kMostCores, 0));
  target.launcher = read_launcher(root, target);
  target.emulator = read_emulator(root, target);
  if (target.emulator) target.launcher = {target.emulator->program};
  if (root.has("power")) target.power = read_power(root.table("power", {"idle_w", "busy_core_w"}));
  target.program_folder = read_program_folder(root, target);
  return target;
}

FileLocation Target::where(std::string_view key) const {
  return toml::place_of(file, key);
}

}  // namespace tether::scenario
