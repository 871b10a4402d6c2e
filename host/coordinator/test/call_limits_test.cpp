#include "coordinator_fixture.h"

#include <cstddef>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// What a SUT could go on with for ever: as much as a program does by purpose is served, more ends
/// the run.
namespace tether::coordinator {
namespace {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;
using std::chrono::seconds;
using testing::HasSubstr;

class StandstillTest : public CoordinatorTest {
 protected:
  void SetUp() override { tick_ = Duration(1000); }
  /// So many calls, each after `compute`, and the finish.
  static ScriptedServer::Script calls(std::size_t count, Duration compute) {
    ScriptedServer::Script script(count, turn(compute, 0.1));
    script.push_back(finish(compute));
    return script;
  }
};

TEST_F(StandstillTest, ALoopOfCallsThatTakeNoTimeEndsTheRun) {
  const RunReport report = run(calls(20'000, Duration(0)));
  EXPECT_EQ(report.end, RunEnd::kSutLost);
  EXPECT_THAT(report.reason, HasSubstr("the SUT of UAV \"uav0\" sent 10001 requests while ST stood "
                                       "at 0.000000 s: a loop that waits must let time go by"));
  EXPECT_EQ(recorder_.interactions.size(), 10'000u);
}

TEST_F(StandstillTest, EachStepOfStAllowsAsManyAgain) {
  ScriptedServer::Script script;
  for (int i = 0; i < 3; ++i) {
    script.insert(script.end(), 9'000, turn(Duration(0), 0.1));
    script.push_back(turn(milliseconds(2), 0.1));
  }
  script.push_back(finish(Duration(0)));
  EXPECT_EQ(run(std::move(script)).end, RunEnd::kFinished);
}

// Whoever is timed by the coordinator's own clock spends time with each call.
TEST_F(StandstillTest, AnUnstampedLoopGoesOn) {
  make();
  server_->add_sut(hello("", link::ClockKind::kUnstamped), calls(20'000, Duration(0)));
  EXPECT_EQ(coordinator_->run(*server_, hooks_).end, RunEnd::kFinished);
}

TEST_F(StandstillTest, CommandsThatWaitToActAreBounded) {
  latency_ = seconds(10);
  const RunReport report = run(calls(80'000, nanoseconds(150)));
  EXPECT_EQ(report.end, RunEnd::kSutLost);
  EXPECT_THAT(report.reason, HasSubstr("a velocity command while 65536 others wait to act"));
  EXPECT_EQ(recorder_.interactions.size(), 65'536u);
}

TEST_F(StandstillTest, AnnotationsAreBounded) {
  make();
  const auto peer = server_->add_sut(hello(), {});
  const std::string json = "{\"x\": \"" + std::string(1'000'000, 'x') + "\"}";
  for (int i = 0; i < 300; ++i) server_->deliver(peer, link::Annotation{ExecTime{}, "step", json});
  const RunReport report = coordinator_->run(*server_);
  EXPECT_EQ(report.end, RunEnd::kSutLost);
  EXPECT_THAT(report.reason,
              HasSubstr("the SUT of UAV \"uav0\" sent annotations of more than 256 MiB"));
  EXPECT_EQ(recorder_.annotations.size(), 268u);
}

}  // namespace
}  // namespace tether::coordinator
