#include "vehicle/stage_log.h"

#include "build_id.h"

#include <gtest/gtest.h>

#include <tether/link/codec.h>

namespace tether::client {
namespace {

using Times = std::vector<link::StageTime>;

ExecTime at(std::int64_t ns) {
  return from_ns<ExecTime>(ns);
}

TEST(StageLog, TheInnermostStageCounts) {
  StageLog log(at(10));
  log.reach(at(11));
  ASSERT_TRUE(log.begin("detect").ok());
  log.reach(at(13));
  ASSERT_TRUE(log.begin("filter").ok());
  log.reach(at(20));
  ASSERT_TRUE(log.end().ok());
  log.reach(at(24));
  ASSERT_TRUE(log.end().ok());
  log.reach(at(32));
  EXPECT_EQ(log.times("camera to command"), (Times{{"camera to command", Duration(9)},
                                                   {"detect", Duration(6)},
                                                   {"filter", Duration(7)}}));
  log.resume(at(50));
  log.reach(at(51));
  EXPECT_EQ(log.times("a to b"), (Times{{"a to b", Duration(1)}}));
}

// CPU times, whose sum is not what the clock says: some of them was left out, or has a factor.
TEST(StageLog, PartsOfAProgramShareTheTimeByWhatEachHasComputed) {
  StageLog log(at(0));
  log.reach(at(100), {{"camera", Duration(10)}, {"tracker", Duration(30)}});
  EXPECT_EQ(log.times("a to b"), (Times{{"camera", Duration(25)}, {"tracker", Duration(75)}}));
  log.resume(at(200));
  log.reach(at(310), {{"camera", Duration(10)}, {"late", Duration(2)}, {"tracker", Duration(31)}});
  EXPECT_EQ(log.times("a to b"), (Times{{"late", Duration(73)}, {"tracker", Duration(37)}}))
      << "to the nanosecond";
  log.resume(at(400));
  log.reach(at(410), {{"camera", Duration(10)}, {"late", Duration(2)}, {"tracker", Duration(31)}});
  EXPECT_EQ(log.times("a to b"), (Times{{"a to b", Duration(10)}})) << "nobody is known";
}

TEST(StageLog, ChargesNothingIfTheClockGoesBack) {
  StageLog log(at(10));
  log.reach(at(4));
  log.reach(at(6));
  EXPECT_EQ(log.times("a to b"), (Times{{"a to b", Duration(2)}}));
}

TEST(StageLog, RefusesNamesAndNumbersThatNoMessageCarries) {
  StageLog log(at(0));
  for (const std::string& name : {std::string(), std::string(257, 'x'), std::string("a\tb")})
    EXPECT_EQ(log.begin(name).failure().kind, Failure::Kind::kInvalid) << name;
  EXPECT_EQ(log.end().failure().kind, Failure::Kind::kInvalid);
  std::size_t begun = 0;
  log.reach(at(0));
  while (log.begin("s" + std::to_string(begun))) {
    ++begun;
    log.reach(at(0));
  }
  EXPECT_EQ(begun, link::kMaxStages - 2);
  EXPECT_LE(log.times("outside").size(), link::kMaxStages);
}

TEST(StageLog, TakesTimeThatIsGivenOncePerCall) {
  StageLog log(at(0));
  Times given{{"detect", Duration(5)}, {"a to b", Duration(3)}, {"other", Duration(7)}};
  EXPECT_EQ(log.take(given, ""), Duration(0));  // outside of stages; not known yet, of which
  ASSERT_TRUE(log.begin("detect").ok());
  EXPECT_EQ(log.take(given, ""), Duration(5));
  EXPECT_EQ(log.take(given, ""), Duration(0));
  ASSERT_TRUE(log.end().ok());
  EXPECT_EQ(log.take(given, "a to b"), Duration(3));
  EXPECT_EQ(log.reached(), at(8));
  EXPECT_EQ(log.times("a to b"), (Times{{"a to b", Duration(3)}, {"detect", Duration(5)}}));
  EXPECT_EQ(given, (Times{{"other", Duration(7)}}));
}

TEST(BuildId, ThisProgramHasOne) {
  EXPECT_EQ(build_id().size(), 40u);
  EXPECT_EQ(build_id().find_first_not_of("0123456789abcdef"), std::string::npos);
}

}  // namespace
}  // namespace tether::client
