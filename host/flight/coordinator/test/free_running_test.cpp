#include "coordinator_fixture.h"

#include <gtest/gtest.h>

namespace tether::coordinator {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using CoordinatorFreeRunning = CoordinatorTest;

TEST_F(CoordinatorFreeRunning, RepliesAtOnceAndChargesNothing) {
  set_free_running(0.25);
  const RunReport report =
      run({read(seconds(5), kRange), read(seconds(5), kCamera), finish(seconds(5))});
  EXPECT_EQ(report.end, RunEnd::kFinished);
  EXPECT_LT(report.st, st_ms(100));
  for (const record::Interaction& entry : recorder_.interactions) {
    EXPECT_EQ(same_instant(entry.request_at), entry.st_at_arrival);
    EXPECT_EQ(entry.reply_at, entry.request_at);
    EXPECT_EQ(entry.st_at_release, entry.st_at_arrival);
  }
  EXPECT_TRUE(simulator_->expected().empty());
  EXPECT_TRUE(std::get<link::Welcome>(server_->sent.at(1).front()).free_running);
}

TEST_F(CoordinatorFreeRunning, SleepsInSimulatedTime) {
  set_free_running(0.25);
  make();
  const link::PeerId peer = add_silent();
  // Its clock, 7 us, is not ST: a relative sleep takes its time from the request on.
  server_->deliver(peer, request(1, us(7), link::Sleep{us(2'000'007), true}));
  std::size_t replies = 0;
  hooks_.should_stop = [&]() -> std::optional<Ending> {
    if (server_->sent[peer].size() != replies + 2) return std::nullopt;
    if (++replies == 1) server_->deliver(peer, request(2, us(9), link::Sleep{us(3'500'300)}));
    if (replies == 2) server_->deliver(peer, request(3, us(9), link::Sleep{us(1)}));
    if (replies == 3) server_->deliver(peer, request(4, us(9), link::Finish{true, "", ""}));
    return std::nullopt;
  };
  const RunReport report = run();
  ASSERT_EQ(report.end, RunEnd::kFinished) << report.reason;
  const auto& sleeps = recorder_.interactions;
  EXPECT_EQ(sleeps.at(0).st_at_release, sleeps[0].st_at_arrival + seconds(2));
  EXPECT_EQ(std::get<link::Reply>(server_->sent[peer].at(1)).resume_at,
            from_ns<ExecTime>(to_ns(sleeps[0].st_at_release)));
  EXPECT_EQ(sleeps.at(1).st_at_release, st_ms(3'501));
  EXPECT_EQ(sleeps.at(2).st_at_release, sleeps[2].st_at_arrival) << "it has passed";
  EXPECT_NEAR(to_seconds(report.wall), 3.5 / 0.25, 0.5);
  EXPECT_EQ(std::get<link::Welcome>(server_->sent[peer].at(0)).real_time_factor, 0.25);
}

TEST_F(CoordinatorFreeRunning, FollowsTheWallClockWithAnyStep) {
  set_free_running(0.5);
  options_.time_limit = seconds(1);
  for (const Duration step : {milliseconds(1), milliseconds(80)}) {
    make(1, step);
    const RunReport report = run({});
    EXPECT_EQ(report.end, RunEnd::kTimeLimit);
    EXPECT_NEAR(to_seconds(report.wall), 2.0, 0.2);
  }
}

}  // namespace
}  // namespace tether::coordinator
