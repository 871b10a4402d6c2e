// Every scenario and campaign in the repository loads.
#include <algorithm>

#include <gtest/gtest.h>

#include <tether/scenario/campaign.h>

namespace tether::scenario {
namespace {

std::vector<std::filesystem::path> toml_files(const std::string& folder) {
  std::vector<std::filesystem::path> files;
  const auto path = std::filesystem::path(TETHER_SOURCE_DIR) / folder;
  for (const auto& entry : std::filesystem::directory_iterator(path)) {
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

TEST(ShippedFiles, EveryScenarioLoadsAndIsNamedAsItsFile) {
  const auto files = toml_files("scenarios");
  EXPECT_FALSE(files.empty());
  for (const auto& file : files) {
    SCOPED_TRACE(file.string());
    EXPECT_EQ(load_scenario(file).name, file.stem());
  }
}

TEST(ShippedFiles, EveryCampaignLoadsAndIsNamedAsItsFile) {
  const auto files = toml_files("campaigns");
  EXPECT_FALSE(files.empty());
  for (const auto& file : files) {
    SCOPED_TRACE(file.string());
    EXPECT_EQ(load_campaign(file).name, file.stem());
  }
}

}  // namespace
}  // namespace tether::scenario
