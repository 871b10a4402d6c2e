#include "group.h"

#include <algorithm>
#include <map>
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
using link::Reply;
using link::Request;

constexpr CallerId kCaller = 7;

Request call_at(ExecTime at, decltype(Request::body) body = link::ReadSensor{}) {
  return {1, at, {}, std::move(body)};
}

/// The ET of each stop that the member has reported.
std::vector<ExecTime> stops(Supervision& member) {
  std::vector<ExecTime> stops;
  for (const Message& message : member.take_outgoing())
    if (const auto* progress = std::get_if<Progress>(&message); progress && progress->stopped)
      stops.push_back(progress->reached);
  return stops;
}

class TwoOnOneBoard : public testing::Test {
 protected:
  TwoOnOneBoard() {
    group_.add(one_);
    group_.add(other_);
  }
  /// Both have asked, and know when their replies are due.
  void ask_both(Duration due, Duration others_due) {
    one_.asked(kCaller, call_at(ExecTime(10ms)));
    other_.asked(kCaller, call_at(ExecTime(10ms)));
    group_.stopped(ExecTime(10ms));
    ASSERT_TRUE(one_.heard(Due{1, ExecTime(due)}).ok());
    EXPECT_FALSE(group_.may_go_on()) << "the other's is not known";
    ASSERT_TRUE(other_.heard(Due{1, ExecTime(others_due)}).ok());
    ASSERT_TRUE(group_.may_go_on());
    group_.go_on();
    stops(one_);
    stops(other_);
  }

  Supervision one_{false, {}}, other_{false, {}};
  Group group_;
};

TEST_F(TwoOnOneBoard, StopAtOneEtAndGoOnWhenBothMay) {
  ask_both(30ms, 50ms);
  EXPECT_EQ(group_.stop_at(), ExecTime(30ms));
  EXPECT_FALSE(group_.must_stop(ExecTime(29ms)));
  ASSERT_TRUE(group_.must_stop(ExecTime(31ms)));
  group_.stopped(ExecTime(31ms));
  EXPECT_FALSE(group_.is_running());
  EXPECT_EQ(stops(one_), std::vector{ExecTime(31ms)});
  EXPECT_EQ(stops(other_), std::vector{ExecTime(31ms)});
  EXPECT_FALSE(group_.may_go_on());
  ASSERT_TRUE(one_.heard(Reply{1, ExecTime(30ms), {}}).ok());
  ASSERT_TRUE(group_.may_go_on());
  group_.go_on();
  EXPECT_EQ(group_.stopped_at(), ExecTime(31ms));
  EXPECT_EQ(one_.take_answers().size(), 1u);
  EXPECT_TRUE(other_.take_answers().empty());
  EXPECT_EQ(group_.stop_at(), ExecTime(50ms));
}

TEST_F(TwoOnOneBoard, DoNotWaitForOneThatIsOver) {
  ask_both(30ms, 50ms);
  group_.stopped(ExecTime(31ms));
  one_.end(std::nullopt);
  ASSERT_TRUE(group_.may_go_on());
  group_.go_on();
  EXPECT_EQ(group_.stop_at(), ExecTime(50ms));
  stops(one_);
  stops(other_);
  group_.stopped(ExecTime(51ms));
  EXPECT_TRUE(stops(one_).empty());
  EXPECT_EQ(stops(other_), std::vector{ExecTime(51ms)});
  EXPECT_FALSE(group_.may_go_on());
}

// The coordinator sends the reply to a receive when no other SUT can send a message at its time.
TEST_F(TwoOnOneBoard, StopLaterThanEachReplyThatTheyWaitFor) {
  ask_both(30ms, 50ms);
  group_.stopped(ExecTime(30ms));
  EXPECT_EQ(stops(one_), std::vector{ExecTime(30ms + 1ns)}) << "due when they stopped";
  EXPECT_EQ(stops(other_), std::vector{ExecTime(30ms + 1ns)});
  ASSERT_TRUE(one_.heard(Reply{1, ExecTime(30ms), {}}).ok());
  group_.pass_dues();
  EXPECT_TRUE(stops(one_).empty()) << "not due any more";
  group_.go_on();

  one_.asked(kCaller, call_at(ExecTime(30ms + 2ns), link::ReceiveMessage{}));
  group_.stopped(ExecTime(40ms));
  ASSERT_TRUE(one_.heard(Due{2, ExecTime(90ms)}).ok());
  stops(one_);
  stops(other_);
  ASSERT_TRUE(one_.heard(Due{2, ExecTime(40ms)}).ok());  // a message has arrived
  group_.pass_dues();
  EXPECT_EQ(stops(one_).back(), ExecTime(40ms + 1ns));
  EXPECT_EQ(stops(other_), std::vector{ExecTime(40ms + 1ns)});
  EXPECT_FALSE(group_.may_go_on());
  ASSERT_TRUE(one_.heard(Reply{2, ExecTime(40ms), {}}).ok());
  EXPECT_TRUE(group_.may_go_on());
  EXPECT_EQ(group_.stopped_at(), ExecTime(40ms + 1ns));
}

/// One member, with a thread or several that call at any time, and what its coordinator knows.
struct Sut {
  Supervision supervision{false, {}};
  ExecTime known{};                        // its bound
  std::vector<Request> undated;            // the coordinator has not said when they are due
  std::map<std::uint64_t, ExecTime> dues;  // of what is open, by sequence
  std::map<std::uint64_t, ExecTime> issued;
  std::vector<ExecTime> stops;
  std::uint64_t calls = 0, answered = 0;
  bool has_finished = false;
};

/// A board of several programs, a clock that runs while the group does, and a simulation that obeys
/// the rules: ST passes no timestamp that a SUT could still put on a request, and each reply is
/// sent when ST is there, and no SUT can send a message any more that comes before it. All parts
/// move in any order.
class Fleet {
 public:
  Fleet(std::uint64_t seed, std::size_t suts) : random_(RandomKey{seed, 0, 0}), suts_(suts) {
    for (Sut& sut : suts_) group_.add(sut.supervision);
  }

  void move() {
    Sut& sut = suts_[random_.bits() % suts_.size()];
    switch (random_.bits() % 7) {
      case 0:
        return let_time_pass();
      case 1:
        return call(sut, random_.bits() % 40 == 0);
      case 2:
        if (group_.is_running()) sut.supervision.progressed(now_);
        return;
      case 3:
        return tell_dues(sut);
      case 4:
        return reply();
      case 5:
        return move_up(sut);
      default:
        return supervise();
    }
  }

  /// No new calls: every open one comes to its end, so nothing blocks.
  void settle() {
    const auto is_open = [](const Sut& sut) {
      return !sut.has_finished && sut.answered < sut.calls;
    };
    for (int i = 0; i < 20'000 && std::ranges::any_of(suts_, is_open); ++i) {
      let_time_pass();
      supervise();
      for (Sut& sut : suts_) tell_dues(sut);
      reply();
    }
    EXPECT_FALSE(std::ranges::any_of(suts_, is_open)) << "the group is blocked";
    expect_equal_stops();
  }

 private:
  void let_time_pass() {
    if (group_.is_running()) now_ += Duration(random_.bits() % 3'000'000);
  }

  void call(Sut& sut, bool finishes) {
    if (!group_.is_running() || sut.supervision.is_over() || sut.calls - sut.answered > 3) return;
    ++sut.calls;
    sut.supervision.asked(kCaller, finishes ? call_at(now_, link::Finish{true, "done", ""})
                                            : call_at(now_, link::ReceiveMessage{}));
  }

  // What the coordinator hears.
  void take_outgoing() {
    for (Sut& sut : suts_)
      for (const Message& message : sut.supervision.take_outgoing()) {
        if (const auto* asked = std::get_if<Request>(&message)) {
          ASSERT_GE(asked->issued_at, sut.known);
          sut.undated.push_back(*asked);
          sut.issued[asked->sequence] = asked->issued_at;
          sut.known = asked->issued_at;
        } else if (const auto* progress = std::get_if<Progress>(&message)) {
          ASSERT_GE(progress->reached, sut.known);
          ASSERT_LE(progress->reached, now_) << "ET that the group did not have";
          if (progress->stopped) sut.stops.push_back(progress->reached);
          sut.known = progress->reached;
        }
      }
  }

  void supervise() {
    if (group_.is_running() && group_.must_stop(now_)) {
      now_ += Duration(random_.bits() % 200'000);  // until the freeze has taken hold
      group_.stopped(now_);
    }
    group_.pass_dues();
    if (!group_.is_running()) {
      ASSERT_LE(group_.stopped_at(), now_ + Duration(100));
      now_ = group_.stopped_at();
    }
    take_outgoing();
    if (group_.is_running() || !group_.may_go_on()) return;
    ASSERT_EQ(group_.stopped_at(), now_) << "a held group has gained ET";
    // Nobody's reply is missing that was due by now.
    for (const Sut& sut : suts_) {
      if (sut.supervision.is_over()) continue;
      ASSERT_TRUE(sut.undated.empty());
      for (const auto& [sequence, due] : sut.dues) ASSERT_GT(due, now_);
    }
    group_.go_on();
    for (Sut& sut : suts_) sut.answered += sut.supervision.take_answers().size();
  }

  void tell_dues(Sut& sut) {
    take_outgoing();
    if (sut.undated.empty() || sut.has_finished) return;
    const Request asked = sut.undated.front();
    sut.undated.erase(sut.undated.begin());
    const bool at_once =
        random_.bits() % 3 == 0 || std::holds_alternative<link::Finish>(asked.body);
    const ExecTime due = asked.issued_at + Duration(at_once ? 0 : random_.bits() % 20'000'000);
    ASSERT_TRUE(sut.supervision.heard(Due{asked.sequence, due}).ok());
    sut.dues[asked.sequence] = due;
    if (std::holds_alternative<link::Finish>(asked.body)) finishing_[&sut] = asked.sequence;
  }

  // A message arrives for a call, maybe at an ET that the group has passed, or at which it stopped.
  void move_up(Sut& sut) {
    if (sut.dues.empty() || sut.has_finished || finishing_.contains(&sut)) return;
    auto& [sequence, due] = *sut.dues.begin();
    const ExecTime arrival = random_.bits() % 2 == 0 ? std::min(due, group_.stopped_at())
                                                     : due - Duration(random_.bits() % 5'000'000);
    due = std::max(sut.issued[sequence], arrival);
    ASSERT_TRUE(sut.supervision.heard(Due{sequence, due}).ok());
    take_outgoing();
  }

  // The earliest reply of all, if ST can be there: each SUT that can still act has come so far and,
  // as each call waits for messages, each one that comes first at equal times even further.
  void reply() {
    Sut* next = nullptr;
    for (Sut& sut : suts_)
      if (!sut.has_finished && !sut.dues.empty() && (!next || earliest(sut) < earliest(*next)))
        next = &sut;
    if (!next) return;
    const ExecTime at = earliest(*next);
    for (const Sut& sut : suts_)
      if (!sut.has_finished && (sut.known < at || (&sut < next && sut.known == at))) return;
    const auto due = std::ranges::find(next->dues, at, [](const auto& d) { return d.second; });
    ASSERT_TRUE(next->supervision.heard(Reply{due->first, at, {}}).ok());
    const auto finishing = finishing_.find(next);
    next->has_finished = finishing != finishing_.end() && finishing->second == due->first;
    next->dues.erase(due);
    if (next->has_finished) next->supervision.end(std::nullopt);  // the coordinator closes
  }

  static ExecTime earliest(const Sut& sut) {
    return std::ranges::min_element(sut.dues, {}, [](const auto& d) { return d.second; })->second;
  }

  // Each member has stopped whenever another one has, until it was over.
  void expect_equal_stops() const {
    for (const Sut& sut : suts_)
      for (const Sut& other : suts_)
        for (const ExecTime at : other.stops)
          if (!sut.stops.empty() && at <= sut.stops.back()) {
            ASSERT_TRUE(std::ranges::binary_search(sut.stops, at)) << at.time_since_epoch().count();
          }
  }

  KeyedRandom random_;
  std::vector<Sut> suts_;
  std::map<const Sut*, std::uint64_t> finishing_;
  Group group_;
  ExecTime now_{};
};

TEST(GroupProperty, NobodyGainsTimeWhileAnotherIsHeldAndNothingBlocks) {
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(seed);
    Fleet fleet(seed, 2 + seed % 4);
    for (int i = 0; i < 600; ++i) fleet.move();
    fleet.settle();
    if (testing::Test::HasFailure()) return;
  }
}

}  // namespace
}  // namespace tether::supervisor
