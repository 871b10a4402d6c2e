#include "options/command_line.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/os/text_file.h>

namespace tether::app {
namespace {

/// What is printed for wrong use.
std::string refusal(std::vector<std::string> words) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  std::optional<os::Interrupt> interrupt;
  testing::internal::CaptureStderr();
  const int code = run_command_line(static_cast<int>(words.size()), arguments.data(), interrupt);
  EXPECT_EQ(code, 2);
  return testing::internal::GetCapturedStderr();
}

TEST(CommandLine, SuggestsTheNearestCommandOrOption) {
  const std::pair<std::vector<std::string>, std::string> cases[] = {
      {{"tether", "rnu", "face_anchor"}, "'run'"},
      {{"tether", "target", "chek"}, "'check'"},
      {{"tether", "run", "x", "--simulatr", "mujoco"}, "'--simulator'"},
      {{"tether", "report", "x", "--fromat=csv"}, "'--format'"}};
  for (const auto& [words, suggested] : cases)
    EXPECT_THAT(refusal(words), testing::HasSubstr(suggested));
}

TEST(CommandLine, WritesWhatIsWrongIntoTheFileForContinuousIntegration) {
  const ScratchFolder scratch;
  const std::string file = scratch.path("junit.xml");
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"tether", "run", "x", "--junit", file, "--outt", "y"},
        std::vector<std::string>{"tether", "run", "x", "--outt", "y", "--junit=" + file}}) {
    std::filesystem::remove(file);
    (void)refusal(words);
    EXPECT_THAT(os::read_file(file), testing::HasSubstr("--outt"));
  }
}

TEST(CommandLine, NamesWhatIsWrongInOneLineWithTheHelpOfItsCommand) {
  const std::pair<std::vector<std::string>, std::pair<std::string, std::string>> cases[] = {
      {{"tether"}, {"command", "tether --help"}},
      {{"tether", "whatever"}, {"command 'whatever'", "tether --help"}},
      {{"tether", "face_anchor"}, {"type: tether run face_anchor", "tether --help"}},
      {{"tether", "campaign", "x", "--flights", "9"}, {"`trials`", "tether campaign --help"}},
      {{"tether", "run"}, {"scenario", "tether run --help"}},
      {{"tether", "campaign", "--", "ls", "x"},
       {"Only `tether run` takes a program", "scenario.toml"}},
      {{"tether", "run", "--"}, {"follows '--'", "tether run --help"}},
      {{"tether", "run", "x", "--", "ls"}, {"'x' is before '--'", "tether run --help"}},
      {{"tether", "run", "--time-limit", "0", "--", "ls"}, {"--time-limit", "0.1 to 604799"}},
      {{"tether", "run", "x", "y"}, {"argument 'y'", "tether run --help"}},
      {{"tether", "world", "check"}, {"world", "tether world check --help"}},
      {{"tether", "run", "x", "--seed", "-1"}, {"--seed", "0 to 2^53, but is '-1'"}},
      {{"tether", "run", "x", "--seed", "many"}, {"--seed", "'many'"}},
      {{"tether", "run", "x", "--seed", "1.5"},
       {"--seed: must be a whole number from 0 to 2^53, but is '1.5'.", "tether run --help"}},
      {{"tether", "size", "x", "--jobs", "1.5"},
       {"--jobs: must be a whole number, but is '1.5'.", "tether size --help"}},
      {{"tether", "run", "--position", "1,2", "--", "true"},
       {"--position: must be 3 values with a comma", "as in 0,0,0.1."}},
      {{"tether", "run", "x", "--slowdown", "nan"}, {"--slowdown", "0.001 to 10000"}},
      {{"tether", "size", "x", "--between", "5"}, {"--between", "tether size --help"}}};
  for (const auto& [words, parts] : cases) {
    const std::string line = refusal(words);
    EXPECT_THAT(line, testing::StartsWith("tether: "));
    EXPECT_THAT(line, testing::HasSubstr(parts.first));
    EXPECT_THAT(line, testing::HasSubstr(parts.second));
    EXPECT_EQ(line.find('\n'), line.size() - 1);
  }
}

}  // namespace
}  // namespace tether::app
