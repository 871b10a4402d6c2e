#include "support/trials.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// Worlds that were read once are kept in a folder of the user, and flights are the same with it.
namespace tether::system_test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

class CacheCommand : public testing::Test {
 protected:
  Output run_with(const std::string& cache, const std::vector<std::string>& arguments) const {
    return run(with(tether(arguments), {}, {{"TETHER_CACHE", cache}}), 120s);
  }
  /// "2 files", …
  std::string size() const {
    const std::string text = run_with(cache_, {"cache"}).out;
    return text.substr(cache_.size() + 2, text.find(',') - cache_.size() - 2);
  }

  TempFolder folder_;
  const std::string cache_ = folder_ / "cache";
};

TEST_F(CacheCommand, ShowsAndClearsWhatWasReadOnce) {
  EXPECT_EQ(size(), "0 files");
  const Output read = run_with(cache_, {"world", "check", "room"});
  EXPECT_NE(size(), "0 files");
  const std::string known = size();
  EXPECT_EQ(run_with(cache_, {"world", "check", "room"}).out, read.out);
  EXPECT_EQ(size(), known);
  EXPECT_EQ(run_with(cache_, {"cache", "--clear"}).code, 0);
  EXPECT_EQ(size(), "0 files");
  EXPECT_THAT(run_with("off", {"cache"}).out, HasSubstr("not kept"));
}

TEST_F(CacheCommand, SaysWhyNothingIsKeptAndWorldsAreReadAllTheSame) {
  folder_.write("file", "");
  const std::string nowhere = folder_ / "file/cache";
  const Output check = run_with(nowhere, {"world", "check", "room"});
  EXPECT_EQ(check.code, 0);
  EXPECT_EQ(check.err, "");
  const Output output = run_with(nowhere, {"cache"});
  EXPECT_EQ(output.code, 3);
  EXPECT_THAT(output.err, HasSubstr(nowhere + ": cannot be written: "));
}

// Images and all.
TEST_F(CacheCommand, ChangesNoFlight) {
  const auto scenario = write_face_scenario(folder_.path(), {kScripted});
  const auto fly = [&](const std::string& cache, const std::string& out) {
    const Output output =
        run_with(cache, {"run", scenario, "--images", "--quiet", "--out", folder_ / out});
    EXPECT_EQ(output.code, 0) << output.err;
  };
  fly("off", "without");
  fly(cache_, "cold");
  fly(cache_, "warm");
  expect_same_runs(folder_ / "without", folder_ / "cold");
  expect_same_runs(folder_ / "without", folder_ / "warm");
}

}  // namespace
}  // namespace tether::system_test
