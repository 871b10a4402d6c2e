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
class Limits : public testing::Test {
 protected:
  /// Whether the run came through; if not, expects a reason that holds one of these words.
  bool fly(const std::filesystem::path& scenario, const std::string& limits,
           const testing::Matcher<std::string>& reason) {
    const auto out = folder_ / "out";
    std::filesystem::remove_all(out);
    const Output output = run(limited(tether({"run", scenario, "--out", out}, mark_), limits));
    EXPECT_THAT(output.code, AnyOf(0, 3)) << limits << ": " << output.err;
    EXPECT_TRUE(wait_until_gone(mark_)) << limits;
    EXPECT_FALSE(std::filesystem::exists(out / "result.json.part")) << limits;
    if (output.code != 0) {
      EXPECT_THAT(output.err, HasSubstr("tether: ")) << limits;
      EXPECT_THAT(output.err, reason) << limits;
    }
    if (std::filesystem::exists(out / "result.json")) {
      EXPECT_EQ(read_result(out)["exit_code"], output.code) << limits;
    }
    return output.code == 0;
  }

  const std::string mark_ = mark_of_test();
  TempFolder folder_;
};

TEST_F(Limits, OfFileHandlesAreAReason) {
  const auto scenario = write_hover_scenario(folder_.path(), "good");
  const auto reason = HasSubstr("Too many open files");
  int refused = 0;
  for (const int handles : {4, 5, 6, 9, 10, 12, 14, 16, 18})
    if (!fly(scenario, "-n " + std::to_string(handles), reason)) ++refused;
  EXPECT_GE(refused, 6);
  EXPECT_TRUE(fly(scenario, "-n 64", HasSubstr("")));
}

TEST_F(Limits, OfFileHandlesAreACampaignsReason) {
  write_hover_scenario(folder_.path(), "good");
  write_text(folder_ / "campaign.toml",
             "name = \"small\"\ntrials = 1\n\n[[scenario]]\nfile = \"hover.toml\"\n"
             "conditions = [\"host\"]\n");
  const auto out = folder_ / "out";
  for (const std::string handles : {"4", "5", "6", "7", "12"}) {
    std::filesystem::remove_all(out);
    const Output output = run(limited(
        tether({"campaign", folder_ / "campaign.toml", "--out", out}, mark_), "-n " + handles));
    EXPECT_EQ(output.code, 3) << handles << ": " << output.err;
    EXPECT_TRUE(wait_until_gone(mark_)) << handles;
    const auto trial = out / "hover/host/seed-0001";
    const bool is_told = std::filesystem::exists(trial / "result.json");
    EXPECT_THAT(is_told ? read_result(trial)["reason"].get<std::string>() : output.err,
                HasSubstr("Too many open files"))
        << handles;
  }
}

#if TETHER_ADDRESS_SANITIZER || TETHER_THREAD_SANITIZER
constexpr bool kTakesAllMemory = true;
#else
constexpr bool kTakesAllMemory = false;
#endif

TEST_F(Limits, OfMemoryAreAReason) {
  if (kTakesAllMemory) GTEST_SKIP() << "the sanitizer needs terabytes of address space";
  const auto scenario = write_hover_scenario(folder_.path(), "look");
  int refused = 0, told = 0;
  for (const int mib : {60, 120, 240, 360, 480, 600})
    if (!fly(scenario, "-v " + std::to_string(1024 * mib), HasSubstr("memory"))) {
      ++refused;
      if (!std::filesystem::exists(folder_ / "out")) continue;  // it had not come so far
      ++told;
      const auto result = read_result(folder_ / "out");
      EXPECT_EQ(result["outcome"], "failed") << mib;
      EXPECT_THAT(result["reason"].get<std::string>(), HasSubstr("memory")) << mib;
    }
  EXPECT_GE(refused, 3);
  EXPECT_GE(told, 1);
}

// What does not fit into memory shows when the first image is drawn.
TEST_F(Limits, OfMemoryForALargeImageAreAReason) {
  if (kTakesAllMemory) GTEST_SKIP() << "the sanitizer needs terabytes of address space";
  const std::string model = std::string(TETHER_SOURCE_DIR) + "/data/models/hummingbird/model.sdf";
  const auto large = folder_ / "large.sdf";
  write_text(large,
             substituted(read_text(model), {{"<width>640</width>", "<width>4096</width>"},
                                            {"<height>480</height>", "<height>4096</height>"}}));
  const auto scenario = write_hover_scenario(folder_.path(), "look", {{model, large.string()}});
  EXPECT_FALSE(fly(scenario, "-v " + std::to_string(1024 * 800),
                   AnyOf(HasSubstr("framebuffer"), HasSubstr("memory"))));
  EXPECT_EQ(read_result(folder_ / "out")["outcome"], "failed");
}

TEST_F(Limits, OfAnImagesSizeAreABadFile) {
  const std::string model = std::string(TETHER_SOURCE_DIR) + "/data/models/hummingbird/model.sdf";
  const auto huge = folder_ / "huge.sdf";
  write_text(huge,
             substituted(read_text(model), {{"<width>640</width>", "<width>100000</width>"}}));
  const auto scenario = write_hover_scenario(folder_.path(), "look", {{model, huge.string()}});
  const Output output = run(tether({"run", scenario, "--out", folder_ / "out"}, mark_));
  EXPECT_EQ(output.code, 2);
  EXPECT_THAT(output.err, StartsWith("tether: " + huge.string() + ":"));
  EXPECT_THAT(output.err, HasSubstr("4096"));
}

}  // namespace
}  // namespace tether::system_test
