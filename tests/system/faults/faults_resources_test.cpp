#include "support/faults.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base_testing/sanitizer.h>

/// Too few file handles, too little memory (docs/guide/faults.md): whatever cannot be had, a run
/// ends with a reason and never by a crash.
namespace tether::system_test {
namespace {

using testing::AnyOf;
using testing::HasSubstr;
using testing::StartsWith;

/// Flies under limits that get looser and looser.
class Limits : public RunTest {
 protected:
  /// Whether the run came through; if not, expects this reason.
  bool fly(const std::filesystem::path& scenario, const std::string& limits,
           const testing::Matcher<std::string>& reason) {
    std::filesystem::remove_all(out_);
    const Output output = run(limited(tether({"run", scenario, "--out", out_}, mark_), limits));
    EXPECT_THAT(output.code, AnyOf(0, 3)) << limits << ": " << output.err;
    EXPECT_TRUE(wait_until_gone(mark_)) << limits;
    EXPECT_FALSE(std::filesystem::exists(out_ / "result.json.part")) << limits;
    if (output.code != 0) {
      EXPECT_THAT(output.err, reason) << limits;
    }
    if (std::filesystem::exists(out_ / "result.json")) {
      EXPECT_EQ(result()["exit_code"], output.code) << limits;
    }
    return output.code == 0;
  }
};

TEST_F(Limits, OfFileHandlesAreAReason) {
  const auto scenario = write_hover_scenario(folder_.path(), "good");
  const auto reason = HasSubstr("open files");
  int refused = 0;
  for (const int handles : {4, 5, 6, 9, 10, 12, 14, 16, 18})
    if (!fly(scenario, "-n " + std::to_string(handles), reason)) ++refused;
  EXPECT_GE(refused, 6);
  EXPECT_TRUE(fly(scenario, "-n 64", HasSubstr("")));
}

TEST_F(Limits, OfFileHandlesAreACampaignsReason) {
  write_hover_scenario(folder_.path(), "good");
  const auto campaign = write_campaign(folder_.path(), 1, "conditions = [\"host\"]\n");
  for (const std::string handles : {"4", "5", "6", "7", "12"}) {
    std::filesystem::remove_all(out_);
    const Output output =
        run(limited(tether({"campaign", campaign, "--out", out_}, mark_), "-n " + handles));
    EXPECT_EQ(output.code, 3) << handles << ": " << output.err;
    EXPECT_TRUE(wait_until_gone(mark_)) << handles;
    const auto trial = out_ / "hover/host/seed-0001";
    const bool is_reported = std::filesystem::exists(trial / "result.json");
    EXPECT_THAT(is_reported ? read_result(trial)["reason"].get<std::string>() : output.err,
                HasSubstr("Too many open files"))
        << handles;
  }
}

constexpr bool kTakesAllMemory = TETHER_ADDRESS_SANITIZER || TETHER_THREAD_SANITIZER;

TEST_F(Limits, OfMemoryAreAReason) {
  if (kTakesAllMemory) GTEST_SKIP() << "the sanitizer needs terabytes of address space";
  const auto scenario = write_hover_scenario(folder_.path(), "look");
  int refused = 0, reported = 0;
  for (const int mib : {60, 120, 240, 360, 480, 600})
    if (!fly(scenario, "-v " + std::to_string(1024 * mib), HasSubstr("memory"))) {
      ++refused;
      if (!std::filesystem::exists(out_)) continue;  // it had not come so far
      ++reported;
      EXPECT_EQ(result()["outcome"], "failed") << mib;
      EXPECT_THAT(reason(), HasSubstr("memory")) << mib;
    }
  EXPECT_GE(refused, 3);
  EXPECT_GE(reported, 1);
}

/// The hover scenario with a camera whose images have that size.
std::filesystem::path write_scenario_of_size(const TempFolder& folder, const std::string& width,
                                             const std::string& height) {
  const std::string model = std::string(TETHER_SOURCE_DIR) + "/data/models/hummingbird/model.sdf";
  write_text(
      folder / "model.sdf",
      substituted(read_text(model), {{"<width>640</width>", "<width>" + width + "</width>"},
                                     {"<height>480</height>", "<height>" + height + "</height>"}}));
  return write_hover_scenario(folder.path(), "look", {{model, folder / "model.sdf"}});
}

// What does not fit into memory shows when the first image is drawn.
TEST_F(Limits, OfMemoryForALargeImageAreAReason) {
  if (kTakesAllMemory) GTEST_SKIP() << "the sanitizer needs terabytes of address space";
  EXPECT_FALSE(fly(write_scenario_of_size(folder_, "4096", "4096"),
                   "-v " + std::to_string(1024 * 600), HasSubstr("memory")));
  EXPECT_EQ(result()["outcome"], "failed");
}

TEST_F(Limits, OfAnImagesSizeAreABadFile) {
  const auto scenario = write_scenario_of_size(folder_, "100000", "480");
  const Output output = run(tether({"run", scenario, "--out", out_}, mark_));
  EXPECT_EQ(output.code, 2);
  EXPECT_THAT(output.err, StartsWith("tether: " + (folder_ / "model.sdf").string() + ":"));
  EXPECT_THAT(output.err, HasSubstr("4096"));
}

}  // namespace
}  // namespace tether::system_test
