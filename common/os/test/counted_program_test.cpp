#include <cstdlib>
#include <fstream>
#include <map>
#include <tuple>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base/count_page.h>
#include <tether/base_testing/scratch_folder.h>
#include <tether/base_testing/thrown_error.h>
#include <tether/os/counted_program.h>

namespace tether::os {
namespace {

using testing::HasSubstr;

class CountedProgram : public testing::Test {
 protected:
  CountedProgram() { ::setenv("TETHER_COUNTER_PLUGIN", plugin_.c_str(), 1); }
  ~CountedProgram() override { ::unsetenv("TETHER_COUNTER_PLUGIN"); }

  ScratchFolder scratch_;
  std::string plugin_ = scratch_.write("plugin.so", "");
  Emulator emulator_{"qemu-aarch64", "cortex-a72", "/root", {7, 8, 9}};
};

TEST_F(CountedProgram, HasAPageOfItsOwnWithTheCosts) {
  const CountFile counts(emulator_), other(emulator_);
  const Environment first = counts.environment();
  const std::map<std::string, std::string> variables(first.begin(), first.end());
  const std::string file = variables.at("TETHER_COUNTS");
  EXPECT_EQ(variables.at("QEMU_PLUGIN"), "file=" + plugin_ + ",page=" + file);
  EXPECT_EQ(variables.at("QEMU_CPU"), "cortex-a72");
  EXPECT_EQ(variables.at("QEMU_LD_PREFIX"), "/root");
  EXPECT_NE(other.environment(), first);

  std::fstream memory(file, std::ios::in | std::ios::out | std::ios::binary);
  CountPage page;
  memory.read(reinterpret_cast<char*>(&page), sizeof page);
  ASSERT_TRUE(memory);
  EXPECT_EQ(page.magic, CountPage::kMagic);
  EXPECT_EQ(page.cost_units, emulator_.cost_units);

  EXPECT_EQ(counts.computed(), Duration(0));
  page.units = 45 * kCostUnitsPerNs + 1;
  memory.seekp(0).write(reinterpret_cast<const char*>(&page), sizeof page).flush();
  EXPECT_EQ(counts.computed(), Duration(45));
  EXPECT_EQ(other.computed(), Duration(0));
}

TEST_F(CountedProgram, BeginsWithTheSameMemoryWhateverItsVariablesAndArguments) {
  // Texts and bytes above the program's stack.
  const auto size = [](const ChildCommand& command) {
    std::pair<std::size_t, std::size_t> sum{0, command.arguments[1].size()};
    const auto add = [&](std::size_t bytes) { ++sum.first, sum.second += bytes + 1; };
    for (const auto& [name, value] : merged_environment(command.environment))
      add(name.size() + value.size() + 1);
    for (std::size_t i = 1; i < command.arguments.size(); ++i) add(command.arguments[i].size());
    return sum;
  };
  ChildCommand bare{.arguments = {"qemu-x86_64", "/bin/p"}, .environment = {}, .log = {}};
  pad_start(bare);
  EXPECT_EQ(size(bare).first % 128, 0u);
  EXPECT_EQ(size(bare).second % (32 * 1024), 0u);
  for (const std::size_t length : {0u, 1u, 7u, 1000u}) {
    ChildCommand other{
        .arguments = {"/usr/bin/qemu-x86_64", "/usr/bin/program", std::string(length, 'a')},
        .environment = {{"ONE", std::string(length, 'x')}, {"TWO", ""}},
        .log = {}};
    pad_start(other);
    EXPECT_EQ(size(other), size(bare)) << length;
  }
}

TEST_F(CountedProgram, HasAPageWhoseNameIsAsLongForEachProcess) {
  const CountFile counts(emulator_);
  const auto first = counts.environment();
  EXPECT_EQ(std::map(first.begin(), first.end()).at("TETHER_COUNTS").size(), 28u);
}

TEST_F(CountedProgram, IsOneOfTheEmulatorsProcessor) {
  const auto elf = [&](const std::string& name, char machine) {
    return scratch_.write(name, std::string("\x7f"
                                            "ELF\2\1\1",
                                            7) +
                                    std::string(11, '\0') + machine);
  };
  const std::string arm = elf("arm", '\xb7'), x86 = elf("x86", '\x3e');
  const std::string script = scratch_.write("script", "#!/bin/sh\nexec true\n");
  const std::string empty = scratch_.write("empty", "");
  for (const auto& [program, own, others] :
       {std::tuple{"qemu-aarch64", arm, x86}, std::tuple{"qemu-x86_64", x86, arm}}) {
    emulator_.program = program;
    require_emulated(emulator_, own);
    for (const std::string& other : {others, script, empty}) {
      const Error error =
          thrown_error(ErrorCode::kSetup, [&] { require_emulated(emulator_, other); });
      EXPECT_EQ(error.subject(), other);
    }
  }
}

TEST_F(CountedProgram, NamesWhatIsMissing) {
  emulator_.program = "no-such-emulator";
  const Error emulator = thrown_error(ErrorCode::kSetup, [&] { find_emulator(emulator_); });
  EXPECT_EQ(emulator.subject(), "no-such-emulator");
  EXPECT_THAT(emulator.what(), HasSubstr("qemu-user"));

  ::setenv("TETHER_COUNTER_PLUGIN", "/nowhere/plugin.so", 1);
  const Error given = thrown_error(ErrorCode::kSetup, [] { find_counter_plugin(); });
  EXPECT_EQ(given.subject(), "TETHER_COUNTER_PLUGIN");
  ::unsetenv("TETHER_COUNTER_PLUGIN");
  const Error none = thrown_error(ErrorCode::kSetup, [] { find_counter_plugin(); });
  EXPECT_THAT(none.what(), HasSubstr("tether-counter"));
}

}  // namespace
}  // namespace tether::os
