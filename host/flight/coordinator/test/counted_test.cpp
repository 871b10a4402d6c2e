#include "coordinator_fixture.h"

#include <chrono>

#include <gtest/gtest.h>

/// What the coordinator makes of the work that a counted SUT has done.
namespace tether::coordinator {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using CountedSut = CoordinatorTest;

TEST_F(CountedSut, IsHungWithoutWorkAndEndsAtTheTimeLimitIfItComputesForEver) {
  options_.hang_limit = seconds(3);
  options_.time_limit = seconds(10);
  for (const bool computes : {false, true}) {
    make();
    server_->add_sut(hello("", computer::ClockKind::kCounted),
                     {sleep(Duration(0), milliseconds(5))});
    hooks_.computed_by = [&](std::size_t) { return computes ? now_ - WallTime{} : Duration(0); };
    const RunReport report = run();
    EXPECT_EQ(report.end, computes ? RunEnd::kTimeLimit : RunEnd::kSutHung);
    EXPECT_EQ(report.st, computes ? st_ms(10'000) : st_ms(5)) << report.reason;
    EXPECT_EQ(recorder_.interactions.size(), 1u);
  }
}

TEST_F(CountedSut, MayTakeTheConnectLimitOfItsOwnTimeToStart) {
  options_.connect_limit = seconds(3);
  make();
  hooks_.computed_by = [&](std::size_t) { return (now_ - WallTime{}) / 10; };
  const RunReport report = run();
  EXPECT_EQ(report.end, RunEnd::kSutLost);
  EXPECT_NEAR(to_seconds(now_ - WallTime{}), 30.0 + 3.0, 0.1);
}

}  // namespace
}  // namespace tether::coordinator
