#include "options/command_line.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
  EXPECT_NE(refusal({"tether", "whatever"}), "");
  EXPECT_NE(refusal({"tether"}), "");
}

}  // namespace
}  // namespace tether::app
