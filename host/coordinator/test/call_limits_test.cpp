#include "coordinator_fixture.h"
#include "validator.h"

#include <cstddef>
#include <string>
#include <utility>

#include <gtest/gtest.h>

/// Limits on calls, commands and annotations, without which a SUT could keep a run from ending.
namespace tether::coordinator {
namespace {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;
using std::chrono::seconds;

class CallLimits : public CoordinatorTest {
 protected:
  void SetUp() override { tick_ = Duration(1000); }
  /// So many calls, each after `compute`, and the finish.
  static ScriptedServer::Script calls(std::size_t count, Duration compute) {
    ScriptedServer::Script script(count, turn(compute, 0.1));
    script.push_back(finish(compute));
    return script;
  }
};

TEST_F(CallLimits, CallsWithoutComputingTimeEndTheRun) {
  EXPECT_EQ(run(calls(20'000, Duration(0))).end, RunEnd::kSutLost);
  EXPECT_EQ(recorder_.interactions.size(), kMaxCallsInAStep);
}

TEST_F(CallLimits, AllowsTheSameNumberAgainInEachStep) {
  ScriptedServer::Script script;
  for (int i = 0; i < 3; ++i) {
    script.insert(script.end(), 9'000, turn(Duration(0), 0.1));
    script.push_back(turn(milliseconds(2), 0.1));
  }
  script.push_back(finish(Duration(0)));
  EXPECT_EQ(run(std::move(script)).end, RunEnd::kFinished);
}

// The coordinator's clock charges time for each call.
TEST_F(CallLimits, AllowsLoopsOfAnUnstampedClient) {
  make();
  server_->add_sut(hello("", link::ClockKind::kUnstamped), calls(20'000, Duration(0)));
  EXPECT_EQ(run().end, RunEnd::kFinished);
}

TEST_F(CallLimits, PendingCommandsAreLimited) {
  latency_ = seconds(10);
  EXPECT_EQ(run(calls(80'000, nanoseconds(150))).end, RunEnd::kSutLost);
  EXPECT_EQ(recorder_.interactions.size(), kMaxWaitingCommands);
}

TEST_F(CallLimits, AnnotationsAreLimited) {
  make();
  const auto peer = add_silent();
  const std::string json = "{\"x\": \"" + std::string(1'000'000, 'x') + "\"}";
  for (int i = 0; i < 300; ++i) server_->deliver(peer, link::Annotation{ExecTime{}, "step", json});
  EXPECT_EQ(run().end, RunEnd::kSutLost);
  EXPECT_EQ(recorder_.annotations.size(), 268u);
}

}  // namespace
}  // namespace tether::coordinator
