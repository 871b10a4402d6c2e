#include "calibration.h"
#include "profile_text.h"
#include "text_table.h"
#include "toml_input.h"

#include <cmath>

namespace tether::sut {
namespace {

constexpr std::size_t kTimesPerLine = 8;

std::string times_text(const char* key, const std::vector<double>& times_ms) {
  std::string text = std::string(key) + " = [";
  for (std::size_t i = 0; i < times_ms.size(); ++i) {
    text += (i % kTimesPerLine == 0 ? "\n  " : " ") + fixed(times_ms[i], 9) + ",";
  }
  return text + "\n]\n";
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

const toml::node& member(const toml::table& table, std::string_view key) {
  const toml::node* node = table.get(key);
  if (node == nullptr) {
    throw BadInput{line_of(table), "lacks the key '" + std::string(key) + "'"};
  }
  return *node;
}

/// Of the type, or not at all.
template <class Value>
Value value_of(const toml::table& table, std::string_view key, const char* what) {
  const toml::node& node = member(table, key);
  const auto value = node.value<Value>();
  if (!value) {
    throw BadInput{line_of(node), "'" + std::string(key) + "' must be " + what};
  }
  return *value;
}

std::string text_of(const toml::table& table, std::string_view key) {
  return value_of<std::string>(table, key, "a string");
}

int integer_of(const toml::table& table, std::string_view key) {
  return static_cast<int>(value_of<std::int64_t>(table, key, "an integer"));
}

const toml::table& table_of(const toml::table& table, std::string_view key) {
  const toml::node& node = member(table, key);
  if (!node.is_table()) {
    throw BadInput{line_of(node), "'" + std::string(key) + "' must be a table"};
  }
  return *node.as_table();
}

std::vector<double> times_of(const toml::table& table, std::string_view key) {
  const toml::node& node = member(table, key);
  std::vector<double> times_ms;
  if (const toml::array* array = node.as_array()) {
    for (const toml::node& element : *array) {
      times_ms.push_back(element.is_number() ? *element.value<double>() : NAN);
      if (!(times_ms.back() > 0.0 && std::isfinite(times_ms.back()))) {
        throw BadInput{line_of(element), "'" + std::string(key) + "' must be times above 0"};
      }
    }
  }
  if (times_ms.empty()) {
    throw BadInput{line_of(node), "'" + std::string(key) + "' must be an array of times"};
  }
  return times_ms;
}

Machine read_machine_table(const toml::table& table) {
  Machine machine;
  machine.name = text_of(table, "name");
  machine.cpu = text_of(table, "cpu");
  machine.architecture = text_of(table, "architecture");
  machine.cores = integer_of(table, "cores");
  machine.cpu_index = integer_of(table, "cpu_index");
  machine.governor = text_of(table, "governor");
  machine.mhz_before = value_of<double>(table, "mhz_before", "a number");
  machine.mhz_after = value_of<double>(table, "mhz_after", "a number");
  return machine;
}

std::vector<BlockTimes> read_blocks(const toml::table& file) {
  const toml::node& node = member(file, "block");
  const toml::array* array = node.as_array();
  if (array == nullptr || !array->is_array_of_tables()) {
    throw BadInput{line_of(node), "'block' must be tables [[block]]"};
  }
  std::vector<BlockTimes> blocks;
  for (const toml::node& element : *array) {
    const toml::table& table = *element.as_table();
    blocks.push_back(
        {text_of(table, "name"), times_of(table, "cpu_ms"), times_of(table, "wall_ms")});
    const std::size_t rounds = blocks.front().cpu_ms.size();
    if (blocks.back().cpu_ms.size() != rounds || blocks.back().wall_ms.size() != rounds) {
      throw BadInput{line_of(table), "the blocks differ in their number of rounds"};
    }
  }
  return blocks;
}

Calibration read_calibration(const toml::table& file) {
  Calibration calibration;
  calibration.workload = integer_of(file, "workload");
  if (calibration.workload != kWorkloadVersion) {
    throw BadInput{line_of(member(file, "workload")),
                   "the workload is " + std::to_string(calibration.workload) +
                       ", and this program's is " + std::to_string(kWorkloadVersion) +
                       "; measure that machine again with the same tether-sut"};
  }
  calibration.program = text_of(file, "program");
  calibration.opencv = text_of(file, "opencv");
  calibration.when = text_of(file, "when");
  calibration.machine = read_machine_table(table_of(file, "machine"));
  calibration.blocks = read_blocks(file);
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
  for (const BlockTimes& block : calibration.blocks) {
    text += "\n[[block]]\nname = " + toml_string(block.name) + "\n" +
            times_text("cpu_ms", block.cpu_ms) + times_text("wall_ms", block.wall_ms);
  }
  return text;
}

Result<Calibration> parse_calibration(const std::string& text, const std::string& path) {
  return read_toml<Calibration>(text, path, read_calibration);
}

Result<Calibration> load_calibration(const std::string& path) {
  const Result<std::string> text = read_text(path, "measurement");
  if (!text) {
    return text.failure();
  }
  return parse_calibration(*text, path);
}

}  // namespace tether::sut
