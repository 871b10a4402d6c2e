#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/base_testing/thrown_error.h>

namespace tether::scenario {

/// Expects Error(kBadFile) at that line, about that key or name.
template <class Load>
void expect_refusal(int line, const std::string& subject, const Load& load) {
  const Error error = bad_file_error(load);
  EXPECT_EQ(error.where().line, line) << error.what();
  EXPECT_EQ(error.subject(), subject) << error.what();
}

/// A change to a file that makes it unusable, with the line and subject of the error.
struct WrongChange {
  std::string from, to;
  int line;
  std::string subject;
};

inline const std::filesystem::path kData = std::filesystem::path(TETHER_TEST_DIR) / "data";

inline std::string data_file(const std::string& name) {
  std::ifstream stream(kData / name);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Files that use every key.
inline const std::string kFullScenario = data_file("project/scenario.toml");
inline const std::string kFullCampaign = data_file("project/campaign.toml");
inline const std::string kFullProfile = data_file("profile.toml");
inline const std::string kFullTarget = data_file("target.toml");
inline const std::string kBoardTarget = data_file("board.toml");
/// A profile with a camera only.
inline const std::string kRigProfile = data_file("project/profiles/rig.toml");

/// Writes the scenario and the files that it names; returns the scenario's file.
inline std::filesystem::path write_project(const ScratchFolder& scratch,
                                           const std::string& scenario) {
  std::filesystem::copy(
      kData / "project", scratch.path(),
      std::filesystem::copy_options::recursive | std::filesystem::copy_options::overwrite_existing);
  return scratch.write("scenario.toml", scenario);
}

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

}  // namespace tether::scenario
