#include <limits>

#include <tether/base/count_page.h>
#include <tether/base/text.h>
#include <tether/calibration/calibration.h>
#include <tether/calibration/characterize.h>
#include <tether/toml/table.h>

namespace tether::calibration {
namespace {

constexpr std::size_t kTimesPerLine = 8;

std::string times_text(const char* key, const std::vector<double>& times_ms) {
  std::string text = std::string(key) + " = [";
  for (std::size_t i = 0; i < times_ms.size(); ++i) {
    text += (i % kTimesPerLine == 0 ? "\n  " : " ") + fixed(times_ms[i], 9) + ",";
  }
  return text + "\n]\n";
}

std::string block_text(const std::string& key, const BlockTimes& block) {
  return "\n[[" + key + "]]\nname = " + toml_string(block.name) + "\n" +
         times_text("cpu_ms", block.cpu_ms) + times_text("wall_ms", block.wall_ms) +
         (block.work.empty() ? "" : times_text("work", block.work));
}

std::string machine_text(const Machine& machine) {
  return "\n[machine]\nname = " + toml_string(machine.name) +
         "\ncpu = " + toml_string(machine.cpu) +
         "\narchitecture = " + toml_string(machine.architecture) +
         "\ncores = " + std::to_string(machine.cores) +
         "\ncpu_index = " + std::to_string(machine.cpu_index) +
         "\ngovernor = " + toml_string(machine.governor) +
         "\nmhz_before = " + fixed(machine.mhz_before, 1) +
         "\nmhz_after = " + fixed(machine.mhz_after, 1) + "\n";
}

// Reading -----------------------------------------------------------------------------------------

using toml::Table;

int integer_of(const Table& table, std::string_view key, int least) {
  return static_cast<int>(table.integer(key, least, std::numeric_limits<int>::max()));
}

Machine read_machine_table(const Table& table) {
  Machine machine;
  machine.name = table.any_text("name");
  machine.cpu = table.any_text("cpu");
  machine.architecture = table.any_text("architecture");
  machine.cores = integer_of(table, "cores", 0);
  machine.cpu_index = integer_of(table, "cpu_index", -1);
  machine.governor = table.any_text("governor");
  machine.mhz_before = table.number("mhz_before", {});
  machine.mhz_after = table.number("mhz_after", {});
  return machine;
}

std::vector<BlockTimes> read_blocks(const Table& file, std::string_view key) {
  constexpr toml::Range kTime_ms{.min = 0.0, .above_min = true};
  constexpr toml::Range kWork{.min = 0.0, .max = 1e15};
  std::vector<BlockTimes> blocks;
  for (const Table& table : file.tables(key)) {
    blocks.push_back({table.any_text("name"), table.numbers("cpu_ms", kTime_ms),
                      table.numbers("wall_ms", kTime_ms)});
    if (table.has("work")) blocks.back().work = table.numbers("work", kWorkClasses, kWork);
    const std::size_t rounds = blocks.front().cpu_ms.size();
    if (blocks.back().cpu_ms.size() != rounds || blocks.back().wall_ms.size() != rounds) {
      throw Error(ErrorCode::kBadFile, table.where(),
                  "the blocks have different numbers of rounds");
    }
  }
  return blocks;
}

Calibration read_calibration(const toml::Document& document) {
  const Table file = document.root();
  Calibration calibration;
  calibration.workload = integer_of(file, "workload", 0);
  if (calibration.workload != kWorkloadVersion) {
    throw Error(ErrorCode::kBadFile, file.where("workload"),
                "the workload has version " + std::to_string(calibration.workload) +
                    ", but this program has version " + std::to_string(kWorkloadVersion) +
                    ". Measure that machine again with the same tether-sut");
  }
  calibration.program = file.any_text("program");
  calibration.opencv = file.any_text("opencv");
  calibration.when = file.any_text("when");
  calibration.machine = read_machine_table(file.table("machine"));
  calibration.blocks = read_blocks(file, "block");
  if (file.has("kernel")) calibration.kernels = read_blocks(file, "kernel");
  return calibration;
}

}  // namespace

std::string calibration_text(const Calibration& calibration) {
  std::string text =
      "# What tether-sut calibrate measured: milliseconds per image, of each round.\n"
      "workload = " +
      std::to_string(calibration.workload) + "\nprogram = " + toml_string(calibration.program) +
      "\nopencv = " + toml_string(calibration.opencv) +
      "\nwhen = " + toml_string(calibration.when) + "\n";
  text += machine_text(calibration.machine);
  for (const BlockTimes& block : calibration.blocks) text += block_text("block", block);
  for (const BlockTimes& kernel : calibration.kernels) text += block_text("kernel", kernel);
  return text;
}

Result<Calibration> parse_calibration(const std::string& text, const std::string& path) {
  return toml::result_of([&] { return read_calibration(toml::Document::parse(text, path)); });
}

Result<Calibration> load_calibration(const std::string& path) {
  return toml::result_of([&] { return read_calibration(toml::Document::load(path)); });
}

}  // namespace tether::calibration
