#include "coordinator_fixture.h"

#include <algorithm>
#include <vector>

// A SUT whose time is replayed: what it is given, and what ends the run.
namespace tether::coordinator {
namespace {

using namespace std::chrono_literals;

struct Call {
  std::string call;
  std::vector<link::StageTime> stages;
};

const std::vector<Call> kRecorded = {
    {"command", {{"start to command", 1ms}}},
    {"command", {{"command to command", 1ms}, {"detect", 4ms}}},
    {"finish", {{"command to finish", 2ms}}},
};

/// Of a program with the build id "0a", which makes these calls only.
class Recorded final : public GivenTime {
 public:
  std::optional<std::string> other_build(const link::Hello& hello) const override {
    return hello.build_id == "0a" ? std::nullopt : std::optional("it is " + hello.build_id);
  }
  std::vector<link::StageTime> given() const override {
    return next_ < kRecorded.size() ? kRecorded[next_].stages : std::vector<link::StageTime>();
  }
  std::optional<std::string> take(const std::string& call,
                                  const std::vector<link::StageTime>& stages) override {
    const Call& expected = kRecorded.at(next_++);
    if (call != expected.call) return "\"" + call + "\"";
    return stages == expected.stages ? std::nullopt : std::optional<std::string>("its stages");
  }
  bool knows(const std::string& stage) const override { return stage != "command to finish"; }

 private:
  std::size_t next_ = 0;
};

class Replayed : public CoordinatorTest {
 protected:
  void make_replay() {
    clock_ = computer::Clock{.kind = computer::ClockKind::kReplayed};
    make();
    options_.uavs[0].given_time = [] { return std::make_unique<Recorded>(); };
    options_.uavs[0].replayed_from = record::ReplayInfo{"a.timing", "exact", "", "pi", "0a"};
    remake();
  }
  link::PeerId join(const std::string& build_id = "0a") {
    link::Hello own = hello("", computer::ClockKind::kReplayed);
    own.build_id = build_id;
    return server_->add_sut(own, {});
  }
  /// As a client sends the calls.
  void send(link::PeerId peer, const std::vector<Call>& calls, Duration late = Duration(0)) {
    ExecTime at{};
    std::uint64_t sequence = 0;
    for (const Call& call : calls) {
      for (const link::StageTime& time : call.stages) at += time.computing;
      link::Request next = request(++sequence, at + late, link::SetVelocity{});
      if (call.call == "finish") next.body = link::Finish{true, "done", ""};
      if (call.call == "sleep") next.body = link::Sleep{at};
      next.stages = call.stages;
      server_->deliver(peer, next);
    }
  }
};

TEST_F(Replayed, GivesEachCallItsTimeAndRecordsTheSource) {
  make_replay();
  const link::PeerId peer = join();
  send(peer, kRecorded);
  ASSERT_EQ(run().end, RunEnd::kFinished);
  std::vector<std::vector<link::StageTime>> given;
  for (const link::Message& message : server_->sent.at(peer)) {
    if (const auto* welcome = std::get_if<link::Welcome>(&message))
      given.push_back(welcome->computing);
    if (const auto* reply = std::get_if<link::Reply>(&message)) given.push_back(reply->computing);
  }
  ASSERT_EQ(given.size(), 4u);
  for (std::size_t i = 0; i < kRecorded.size(); ++i) {
    EXPECT_EQ(given[i], kRecorded[i].stages) << i;
    EXPECT_EQ(recorder_.interactions[i].stages.size(), kRecorded[i].stages.size());
  }
  EXPECT_EQ(recorder_.interactions[1].request_at, us(6000));
  EXPECT_EQ(recorder_.interactions[1].stages[1], (record::StageTime{"detect", 4ms}));
  EXPECT_TRUE(recorder_.interactions[2].stages[0].is_unknown);
  EXPECT_EQ(recorder_.header.suts[0].replay, options_.uavs[0].replayed_from);
  EXPECT_EQ(recorder_.header.suts[0].build_id, "0a");
}

TEST_F(Replayed, EndsTheRunAtTheFirstCallThatDiffers) {
  std::vector<Call> other_call = kRecorded, other_stage = kRecorded;
  other_call[1].call = "sleep";
  other_stage[1].stages[1].stage = "track";
  for (const auto& [calls, late, named] :
       {std::tuple(other_call, 0ns, "\"sleep\""), std::tuple(other_stage, 0ns, "its stages"),
        std::tuple(kRecorded, 1ns, "1000001")}) {
    make_replay();
    const link::PeerId peer = join();
    send(peer, calls, late);
    const RunReport report = run();
    EXPECT_EQ(report.end, RunEnd::kTimingDiffers) << named;
    EXPECT_NE(report.reason.find(named), std::string::npos) << report.reason;
    EXPECT_EQ(refusal(peer).reason, link::Refusal::Reason::kBadRequest);
  }
}

TEST_F(Replayed, RefusesAnotherBuild) {
  make_replay();
  const link::PeerId peer = join("0b");
  hooks_.should_stop = [] { return Ending{RunEnd::kInterrupted, "enough"}; };
  run();
  EXPECT_EQ(refusal(peer).reason, link::Refusal::Reason::kBadRequest);
  EXPECT_NE(refusal(peer).message.find("0b"), std::string::npos);
}

}  // namespace
}  // namespace tether::coordinator
