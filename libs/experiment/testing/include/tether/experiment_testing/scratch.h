#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include <tether/base/error.h>
#include <tether/experiment/result.h>
#include <tether/scenario/campaign.h>

namespace tether::experiment {

/// A folder of the running test's own, gone with it.
class Scratch {
 public:
  Scratch() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() /
              ("tether_" + std::string(info->test_suite_name()) + "_" + info->name() + "_" +
               std::to_string(getpid()));
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ~Scratch() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  std::filesystem::path path(const std::string& name) const { return folder_ / name; }
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories(path(name).parent_path());
    std::ofstream(path(name), std::ios::binary) << text;
    return path(name);
  }

 private:
  std::filesystem::path folder_;
};

/// The message of the Error of that code that `action` throws; fails the test when there is none.
template <class Action>
std::string error_message(ErrorCode code, const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(name(error.code()), name(code));
    return error.what();
  }
  ADD_FAILURE() << "no error";
  return "";
}

/// Three conditions as in the paper's Section V, two metrics, seeds 1 to 3; files are in `scratch`.
scenario::Campaign make_campaign(const Scratch& scratch);

/// A trial that ran well.
TrialResult make_trial(const scenario::Scenario& scenario, const std::string& condition,
                       std::uint64_t seed, double oscillations, double time_required_s);

}  // namespace tether::experiment
