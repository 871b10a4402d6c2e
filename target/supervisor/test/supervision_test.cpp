#include "supervision.h"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <tether/base/random.h>

namespace tether::supervisor {
namespace {

using namespace std::chrono_literals;
using link::Due;
using link::Message;
using link::Progress;
using link::Refusal;
using link::Reply;
using link::Request;

ExecTime et(Duration since_start) {
  return ExecTime(since_start);
}

Request request(Duration at, decltype(Request::body) body = link::ReadSensor{}) {
  return {1, et(at), {}, std::move(body)};
}

template <class T>
std::vector<T> all(const std::vector<Message>& messages) {
  std::vector<T> out;
  for (const auto& message : messages) {
    if (const auto* found = std::get_if<T>(&message)) out.push_back(*found);
  }
  return out;
}

class SupervisionTest : public testing::Test {
 protected:
  Supervision group_{false, et(0ms)};
};

TEST_F(SupervisionTest, StopsEarlierForAMessageThatHasArrived) {
  group_.asked(7, request(10ms, link::ReceiveMessage{30ms}));
  group_.stopped(et(10ms));
  ASSERT_TRUE(group_.heard(Due{1, et(40ms)}).ok());
  group_.go_on();
  group_.take_outgoing();
  ASSERT_TRUE(group_.heard(Due{1, et(20ms)}).ok());
  EXPECT_FALSE(group_.must_stop(et(19ms)));
  EXPECT_TRUE(group_.must_stop(et(22ms)));
  group_.stopped(et(22ms));
  const auto stops = all<Progress>(group_.take_outgoing());
  ASSERT_EQ(stops.size(), 1u);
  EXPECT_EQ(stops[0].dues_heard, 2u);
  EXPECT_FALSE(group_.may_go_on());
  ASSERT_TRUE(group_.heard(Reply{1, et(20ms), {}}).ok());
  EXPECT_TRUE(group_.may_go_on());
}

TEST_F(SupervisionTest, StaysStoppedForAMessageAndSaysSo) {
  group_.asked(7, request(10ms, link::ReceiveMessage{30ms}));
  group_.asked(8, request(10ms));
  group_.stopped(et(12ms));
  ASSERT_TRUE(group_.heard(Due{1, et(40ms)}).ok());
  ASSERT_TRUE(group_.heard(Due{2, et(11ms)}).ok());
  group_.take_outgoing();
  ASSERT_TRUE(group_.heard(Due{1, et(12ms)}).ok());
  const auto stops = all<Progress>(group_.take_outgoing());
  ASSERT_EQ(stops.size(), 1u);
  EXPECT_EQ(stops[0].reached, et(12ms));
  EXPECT_TRUE(stops[0].stopped);
  EXPECT_EQ(stops[0].dues_heard, 3u);
  ASSERT_TRUE(group_.heard(Reply{2, et(11ms), {}}).ok());
  EXPECT_FALSE(group_.may_go_on());
}

TEST_F(SupervisionTest, RefusesALaterDueAndOneForAnotherCall) {
  group_.asked(7, request(10ms, link::ReceiveMessage{30ms}));
  group_.asked(8, request(10ms));
  group_.stopped(et(12ms));
  ASSERT_TRUE(group_.heard(Due{1, et(40ms)}).ok());
  ASSERT_TRUE(group_.heard(Due{2, et(40ms)}).ok());
  EXPECT_FALSE(group_.heard(Due{1, et(41ms)}).ok());
  EXPECT_FALSE(group_.heard(Due{2, et(39ms)}).ok());
}

TEST_F(SupervisionTest, StopsForARequestAndAgainForItsReply) {
  EXPECT_FALSE(group_.must_stop(et(10ms)));
  group_.asked(7, request(10ms));
  EXPECT_TRUE(group_.must_stop(et(10ms)));
  EXPECT_TRUE(group_.take_outgoing().empty());
  group_.stopped(et(11ms));
  const auto sent = group_.take_outgoing();
  ASSERT_EQ(sent.size(), 2u);
  EXPECT_EQ(std::get<Request>(sent[0]).issued_at, et(10ms));
  EXPECT_EQ(std::get<Progress>(sent[1]).reached, et(11ms));
  EXPECT_TRUE(std::get<Progress>(sent[1]).stopped);
  EXPECT_FALSE(group_.may_go_on());
  ASSERT_TRUE(group_.heard(Due{1, et(47ms)}).ok());
  ASSERT_TRUE(group_.may_go_on());
  group_.go_on();
  EXPECT_EQ(group_.stop_at(), et(47ms));
  EXPECT_FALSE(group_.must_stop(et(46ms)));
  EXPECT_TRUE(group_.must_stop(et(47ms)));
  group_.stopped(et(48ms));
  EXPECT_FALSE(group_.may_go_on());
  ASSERT_TRUE(group_.heard(Reply{1, et(47ms), std::nullopt}).ok());
  ASSERT_TRUE(group_.may_go_on());
  group_.go_on();
  const auto answers = group_.take_answers();
  ASSERT_EQ(answers.size(), 1u);
  EXPECT_EQ(answers[0].caller, 7u);
  EXPECT_EQ(group_.stopped_at(), et(48ms));
}

TEST_F(SupervisionTest, OrdersRequestsAndRaisesLateTimestamps) {
  group_.progressed(et(20ms));
  group_.asked(1, request(22ms));
  group_.asked(2, request(19ms));  // frozen between stamping and handing over
  group_.asked(3, request(30ms));  // of a process that does not stop
  group_.stopped(et(25ms));
  const auto sent = all<Request>(group_.take_outgoing());
  ASSERT_EQ(sent.size(), 3u);
  EXPECT_EQ(sent[0].issued_at, et(20ms));
  EXPECT_EQ(sent[1].issued_at, et(22ms));
  EXPECT_EQ(sent[2].issued_at, et(25ms));
  EXPECT_EQ(sent[2].sequence, 3u);
}

TEST_F(SupervisionTest, FinishEndsEveryOtherCall) {
  group_.asked(1, request(10ms));
  group_.asked(2, request(11ms, link::Finish{true, "done", ""}));
  group_.stopped(et(12ms));
  ASSERT_TRUE(group_.heard(Due{1, et(40ms)}).ok());
  ASSERT_TRUE(group_.heard(Due{2, et(11ms)}).ok());
  EXPECT_FALSE(group_.may_go_on());
  ASSERT_TRUE(group_.heard(Reply{2, et(11ms), std::nullopt}).ok());
  group_.go_on();
  group_.asked(3, request(13ms));
  EXPECT_FALSE(group_.must_stop(et(50ms)));
  const auto answers = group_.take_answers();
  ASSERT_EQ(answers.size(), 3u);
  EXPECT_TRUE(std::holds_alternative<Reply>(*answers[0].message));
  for (int i = 1; i < 3; ++i) {
    EXPECT_EQ(std::get<Refusal>(*answers[size_t(i)].message).reason, Refusal::Reason::kRunEnded);
  }
}

// The coordinator closes once it has answered a finish: both may be heard in one go.
TEST_F(SupervisionTest, FinishSucceedsIfTheCoordinatorClosesAtOnce) {
  group_.asked(1, request(10ms));
  group_.asked(2, request(11ms, link::Finish{true, "done", ""}));
  group_.asked(3, request(12ms));
  group_.asked(4, request(12ms));
  group_.stopped(et(12ms));
  const Duration dues[] = {11ms, 11ms, 40ms, 12ms};
  for (std::uint64_t i = 1; i <= 4; ++i) ASSERT_TRUE(group_.heard(Due{i, et(dues[i - 1])}).ok());
  for (std::uint64_t i = 1; i <= 3; ++i) {
    ASSERT_TRUE(group_.heard(Reply{i, et(dues[i - 1]), std::nullopt}).ok());
  }
  group_.end(std::nullopt);
  EXPECT_TRUE(group_.is_finished());
  std::map<CallerId, Message> got;
  for (const Answer& answer : group_.take_answers()) {
    ASSERT_TRUE(answer.message);
    got.emplace(answer.caller, *answer.message);
  }
  ASSERT_EQ(got.size(), 4u);
  EXPECT_TRUE(std::holds_alternative<Reply>(got.at(1)));
  EXPECT_TRUE(std::holds_alternative<Reply>(got.at(2)));
  // One is from the future, one is not there.
  for (const CallerId other : {3u, 4u}) {
    EXPECT_EQ(std::get<Refusal>(got.at(other)).reason, Refusal::Reason::kRunEnded);
  }
}

TEST_F(SupervisionTest, RunsAndHangsUpOnceTheCoordinatorIsGone) {
  group_.asked(1, request(10ms, link::Finish{true, "done", ""}));
  group_.stopped(et(12ms));
  ASSERT_TRUE(group_.heard(Due{1, et(10ms)}).ok());
  group_.end(std::nullopt);
  EXPECT_FALSE(group_.is_finished()) << "the finish was not confirmed";
  ASSERT_TRUE(group_.may_go_on());
  group_.go_on();
  group_.asked(2, request(13ms));
  const auto answers = group_.take_answers();
  ASSERT_EQ(answers.size(), 2u);
  EXPECT_FALSE(answers[0].message);
  EXPECT_FALSE(answers[1].message);
}

TEST_F(SupervisionTest, DisconnectedCallerGetsNoReplyAndBlocksNoOther) {
  group_.asked(1, request(10ms));
  group_.stopped(et(12ms));
  group_.gone(1);
  ASSERT_TRUE(group_.heard(Due{1, et(12ms)}).ok());
  ASSERT_TRUE(group_.heard(Reply{1, et(12ms), std::nullopt}).ok());
  group_.go_on();
  EXPECT_TRUE(group_.take_answers().empty());
}

TEST_F(SupervisionTest, RefusesMessagesThatBreakTheProtocol) {
  EXPECT_FALSE(group_.heard(Due{1, et(5ms)}).ok());
  EXPECT_FALSE(group_.heard(Reply{1, et(5ms), std::nullopt}).ok());
  group_.asked(1, request(10ms));
  group_.stopped(et(12ms));
  EXPECT_FALSE(group_.heard(Due{1, et(5ms)}).ok());
  EXPECT_FALSE(group_.heard(Reply{1, et(10ms), std::nullopt}).ok());
  EXPECT_TRUE(group_.heard(Due{1, et(10ms)}).ok());
  EXPECT_FALSE(group_.heard(Due{1, et(11ms)}).ok());
  EXPECT_FALSE(group_.heard(Reply{1, et(11ms), std::nullopt}).ok());
  EXPECT_TRUE(group_.heard(Reply{1, et(10ms), std::nullopt}).ok());
}

TEST(FreeSupervision, ShortensNoRelativeSleepWhenItRaisesAStamp) {
  Supervision group(true, et(0ms));
  group.progressed(et(20ms));
  group.asked(1, request(19ms, link::Sleep{et(49ms), true}));
  group.asked(2, request(19ms, link::Sleep{et(49ms)}));
  const auto sent = all<Request>(group.take_outgoing());
  ASSERT_EQ(sent.size(), 2u);
  EXPECT_EQ(sent[0].issued_at, et(20ms));
  EXPECT_EQ(std::get<link::Sleep>(sent[0].body).until, et(50ms));
  EXPECT_EQ(std::get<link::Sleep>(sent[1].body).until, et(49ms));
}

TEST(FreeSupervision, PassesEverythingThroughAndNeverStops) {
  Supervision group(true, et(0ms));
  group.asked(1, request(10ms));
  group.asked(2, request(9ms));
  EXPECT_EQ(all<Request>(group.take_outgoing()).size(), 2u);
  EXPECT_FALSE(group.must_stop(et(1s)));
  ASSERT_TRUE(group.heard(Reply{2, et(20ms), std::nullopt}).ok());
  const auto answers = group.take_answers();
  ASSERT_EQ(answers.size(), 1u);
  EXPECT_EQ(answers[0].caller, 2u);
}

/// A group of callers, a coordinator with a will of its own, and a manual clock; the parts move in
/// any order.
class World {
 public:
  explicit World(std::uint64_t seed) : random_(RandomKey{seed, 0, 0}) {}

  void move() {
    switch (random_.bits() % 5) {
      case 0:
        return let_time_pass();
      case 1:
        return call();
      case 2:
        return coordinate();
      case 3:
        if (group_.is_running()) group_.progressed(now_);
        return;
      default:
        return supervise();
    }
  }
  /// No new calls: everything that is open must come to its end.
  void settle() {
    for (int i = 0; i < 10'000 && !open_calls_.empty(); ++i) {
      let_time_pass();
      supervise();
      coordinate();
    }
    EXPECT_TRUE(open_calls_.empty()) << open_calls_.size() << " calls were never answered";
  }
  /// The coordinator goes, with a thread's finish answered or not. Every open call is answered:
  /// with its reply exactly if that is there and due.
  void lose_coordinator() {
    const bool finishes = random_.bits() % 2 == 0 && group_.is_running() && finish();
    take_outgoing();
    group_.end(std::nullopt);
    EXPECT_EQ(group_.is_finished(), finishes);
    for (const Answer& answer : group_.take_answers()) {
      const bool got_reply = answer.message && std::holds_alternative<Reply>(*answer.message);
      EXPECT_EQ(got_reply, replied_.count(answer.caller) == 1);
      EXPECT_EQ(answer.message.has_value(), got_reply || finishes);
      EXPECT_EQ(open_calls_.erase(answer.caller), 1u);
    }
    EXPECT_TRUE(open_calls_.empty());
    EXPECT_TRUE(group_.is_running() || group_.may_go_on());
  }

 private:
  // Asks, is stopped and answered.
  bool finish() {
    const CallerId caller = ++last_caller_;
    open_calls_[caller] = now_;
    Request r = request({}, link::Finish{true, "done", ""});
    r.issued_at = now_;
    group_.asked(caller, r);
    group_.stopped(now_);
    take_outgoing();
    const auto asked = std::find_if(undated_.begin(), undated_.end(), [](const Request& u) {
      return std::holds_alternative<link::Finish>(u.body);
    });
    EXPECT_TRUE(group_.heard(Due{asked->sequence, asked->issued_at}).ok());
    EXPECT_TRUE(group_.heard(Reply{asked->sequence, asked->issued_at, std::nullopt}).ok());
    replied_.insert(caller);
    return true;
  }

  void let_time_pass() {
    if (group_.is_running()) now_ += Duration(random_.bits() % 3'000'000);
  }

  // A thread stamps now, or did so a little before it was stopped.
  void call() {
    if (!group_.is_running() || open_calls_.size() > 5) return;
    const Duration late(random_.bits() % 4 == 0 ? random_.bits() % 100'000 : 0);
    const CallerId caller = ++last_caller_;
    open_calls_[caller] = std::max(now_ - late, ExecTime{});
    Request r = request({}, link::ReadSensor{static_cast<std::uint32_t>(caller)});
    r.issued_at = open_calls_[caller];
    group_.asked(caller, r);
  }

  void supervise() {
    if (group_.is_running() && group_.must_stop(now_)) {
      now_ += Duration(random_.bits() % 200'000);  // until the freeze has taken hold
      group_.stopped(now_);
    }
    take_outgoing();
    if (!group_.is_running() && group_.may_go_on()) go_on();
  }

  void go_on() {
    const ExecTime at = group_.stopped_at();
    ASSERT_GE(at, now_);
    now_ = at;
    group_.go_on();
    for (const Answer& answer : group_.take_answers()) {
      const auto& reply = std::get<Reply>(*answer.message);
      ASSERT_EQ(open_calls_.count(answer.caller), 1u);
      ASSERT_EQ(reply.sequence, 1u);  // the caller's own
      ASSERT_LE(reply.resume_at, at);
      ASSERT_GE(reply.resume_at, open_calls_[answer.caller]);
      open_calls_.erase(answer.caller);
      replied_.erase(answer.caller);
    }
    // The group does not run while a reply is due.
    ASSERT_TRUE(undated_.empty());
    for (const auto& [sequence, due] : unanswered_) ASSERT_GT(due, at) << sequence;
  }

  void take_outgoing() {
    for (const Message& message : group_.take_outgoing()) {
      if (const auto* r = std::get_if<Request>(&message)) {
        ASSERT_GE(r->issued_at, said_);
        ASSERT_EQ(r->sequence, ++sequence_);
        said_ = r->issued_at;
        undated_.push_back(*r);
        const auto* read = std::get_if<link::ReadSensor>(&r->body);
        if (read != nullptr) caller_of_[r->sequence] = read->sensor;
      }
      if (const auto* p = std::get_if<Progress>(&message)) {
        ASSERT_GE(p->reached, said_);
        ASSERT_LE(p->reached, now_);
        said_ = p->reached;
      }
    }
  }

  // Says when replies are due, in any order, and gives those for which the group has come far
  // enough for the simulation to be there.
  void coordinate() {
    take_outgoing();
    if (!undated_.empty() && random_.bits() % 2 == 0) {
      const auto which =
          undated_.begin() + static_cast<std::ptrdiff_t>(random_.bits() % undated_.size());
      const Duration delay(random_.bits() % 3 == 0 ? 0 : random_.bits() % 20'000'000);
      const ExecTime due = which->issued_at + delay;
      ASSERT_TRUE(group_.heard(Due{which->sequence, due}).ok());
      unanswered_[which->sequence] = due;
      undated_.erase(which);
    }
    const auto ready = std::find_if(unanswered_.begin(), unanswered_.end(),
                                    [this](const auto& u) { return u.second <= said_; });
    if (ready == unanswered_.end() || random_.bits() % 2 == 0) return;
    ASSERT_TRUE(group_.heard(Reply{ready->first, ready->second, std::nullopt}).ok());
    replied_.insert(caller_of_[ready->first]);
    unanswered_.erase(ready);
  }

  KeyedRandom random_;
  Supervision group_{false, ExecTime{}};
  ExecTime now_{};
  std::map<std::uint64_t, CallerId> caller_of_;
  std::set<CallerId> replied_;  // with replies that they have not been given
  ExecTime said_{};             // the latest that the coordinator heard
  std::uint64_t sequence_ = 0;
  CallerId last_caller_ = 0;
  std::map<CallerId, ExecTime> open_calls_;  // and their stamps
  std::vector<Request> undated_;
  std::map<std::uint64_t, ExecTime> unanswered_;
};

TEST(SupervisionProperty, HoldsTheRulesHoweverEverythingInterleaves) {
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(seed);
    World world(seed);
    for (int i = 0; i < 500; ++i) world.move();
    world.settle();
    if (testing::Test::HasFailure()) return;
  }
}

TEST(SupervisionProperty, AnswersEveryCallWhenTheCoordinatorGoes) {
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(seed);
    World world(seed);
    for (std::uint64_t i = 0; i < 20 + seed % 50; ++i) world.move();
    world.lose_coordinator();
    if (testing::Test::HasFailure()) return;
  }
}

}  // namespace
}  // namespace tether::supervisor
