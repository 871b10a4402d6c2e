#include <gtest/gtest.h>

#include <tether/os/child_process.h>

namespace tether::os {
namespace {

constexpr Duration kLong = std::chrono::seconds(60);

TEST(RunCaptured, ReturnsOutputErrorsAndExitCode) {
  const Captured captured =
      run_captured({"sh", "-c", "cat; echo problem >&2; exit 3"}, "the input\n", kLong);
  EXPECT_EQ(captured.out, "the input\n");
  EXPECT_EQ(captured.err, "problem\n");
  EXPECT_EQ(captured.code, 3);
  EXPECT_FALSE(captured.timed_out);
  EXPECT_GT(captured.wall, Duration(0));
}

TEST(RunCaptured, PassesAnInputLargerThanAPipe) {
  const std::string input(1 << 20, 'x');
  EXPECT_EQ(run_captured({"cat"}, input, kLong).out, input);
}

TEST(RunCaptured, EndsAProgramAtItsLimitOrWhenAStopIsRequested) {
  std::stop_source stop;
  stop.request_stop();
  for (const Captured& captured : {run_captured({"sleep", "60"}, "", Duration(0)),
                                   run_captured({"sleep", "60"}, "", kLong, stop.get_token())}) {
    EXPECT_TRUE(captured.timed_out);
    EXPECT_EQ(captured.code, -1);
  }
}

}  // namespace
}  // namespace tether::os
