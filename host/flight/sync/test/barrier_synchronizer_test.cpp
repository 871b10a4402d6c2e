#include <vector>

#include <gtest/gtest.h>

#include <tether/sync/barrier_synchronizer.h>

namespace tether::sync {
namespace {

constexpr Duration kDt_1us{1000};

ExecTime et(std::int64_t ns) {
  return from_ns<ExecTime>(ns);
}
SimTime st(std::int64_t ns) {
  return from_ns<SimTime>(ns);
}

BarrierSynchronizer with_suts(std::vector<std::int64_t> starts) {
  BarrierSynchronizer barrier{StepGrid(kDt_1us)};
  for (const auto start : starts) barrier.add(et(start));
  return barrier;
}

void request(BarrierSynchronizer& barrier, SutIndex sut, std::int64_t at, std::int64_t reply_at,
             std::int64_t now = 0) {
  barrier.arrive(sut, et(at), st(now));
  barrier.hold({sut, et(reply_at)});
}

TEST(Barrier, NamesPoliciesAndViolations) {
  EXPECT_EQ(name(SyncPolicy::kConservativeBarrier), "conservative_barrier");
  EXPECT_EQ(name(SyncPolicy::kFreeRunning), "free_running");
  EXPECT_EQ(name(CausalityViolation::Kind::kRequestInThePast), "request in the past");
}

// Rule 4: a computing SUT bounds ST by the floor of the last ET it is known to have reached.
TEST(Barrier, StIsBoundedByTheFloorOfTheLeastBound) {
  EXPECT_EQ(with_suts({}).lower_bound(), SimTime::max());
  EXPECT_EQ(with_suts({0}).lower_bound(), st(0));
  EXPECT_EQ(with_suts({999}).lower_bound(), st(0));
  EXPECT_EQ(with_suts({1000}).lower_bound(), st(1000));
  EXPECT_EQ(with_suts({2500, 1999}).lower_bound(), st(1000));
  EXPECT_EQ(with_suts({5000, 7000, 5001}).lower_bound(), st(5000));
}

TEST(Barrier, ProgressOnlyRaisesTheBoundOfAComputingSut) {
  auto barrier = with_suts({0});
  barrier.progress(0, et(4200));
  EXPECT_EQ(barrier.lower_bound(), st(4000));
  barrier.progress(0, et(1000));
  EXPECT_EQ(barrier.lower_bound(), st(4000));
  request(barrier, 0, 4500, 6500, 4000);
  barrier.progress(0, et(9000));
  EXPECT_EQ(barrier.lower_bound(), st(6000));
}

// Rule 3: released exactly at floor(t_rep); the bound on ST excludes later releases.
TEST(Barrier, ReleasesWhenStHasReachedTheFloorOfTheReply) {
  for (const std::int64_t reply_ns : {0, 1, 999, 1000, 1001, 54'321}) {
    const std::int64_t released_ns = reply_ns / kDt_1us.count() * kDt_1us.count();
    auto barrier = with_suts({0});
    request(barrier, 0, 0, reply_ns);
    EXPECT_EQ(barrier.lower_bound(), st(released_ns));
    for (std::int64_t now = 0; now < released_ns; now += kDt_1us.count())
      EXPECT_FALSE(barrier.release(st(now))) << now;
    const auto grant = barrier.release(st(released_ns));
    ASSERT_TRUE(grant) << reply_ns;
    EXPECT_EQ(grant->released_at, st(released_ns));
    EXPECT_EQ(grant->resume_at, et(reply_ns));  // rule 5
    EXPECT_FALSE(barrier.is_held(0));
    EXPECT_EQ(barrier.bound(0), et(reply_ns));
    EXPECT_FALSE(barrier.release(st(released_ns)));
  }
}

// Rule 3, second half: a reply waits while another SUT could still stamp an earlier command that
// acts at or before the boundary of its release.
TEST(Barrier, WaitsForEarlierCommandsOfComputingSuts) {
  const struct {
    const char* what;
    std::int64_t reply_ns;
    std::int64_t other_ns;
    bool may_resume;
  } cases[] = {
      {"the other may still act at this very boundary", 3400, 3000, false},
      {"the other's commands act at the next boundary", 3400, 3001, true},
      {"the other cannot be earlier", 3000, 3000, true},
      {"the other is later in the same step", 3400, 3900, true},
      {"the other is steps ahead", 3400, 9000, true},
  };
  for (const auto& c : cases) {
    auto barrier = with_suts({3000, c.other_ns});
    request(barrier, 0, 3000, c.reply_ns, 3000);
    EXPECT_EQ(barrier.release(st(3000)).has_value(), c.may_resume) << c.what;
  }
}

TEST(Barrier, ReleasesInTheOrderOfTimestampsThenIndices) {
  auto barrier = with_suts({0, 0, 0});
  request(barrier, 0, 0, 700);
  request(barrier, 1, 0, 300);
  request(barrier, 2, 0, 300);
  std::vector<SutIndex> order;
  while (const auto grant = barrier.release(st(0))) {
    order.push_back(grant->sut);
    barrier.progress(grant->sut, et(800));
  }
  EXPECT_EQ(order, (std::vector<SutIndex>{1, 2, 0}));
}

TEST(Barrier, ChargesAStampInThePastAtTheBound) {
  auto barrier = with_suts({0});
  EXPECT_EQ(barrier.arrive(0, et(5345), st(0)).lag, Duration(5345));
  barrier.hold({0, et(6000)});
  ASSERT_TRUE(barrier.release(st(6000)));
  const Arrival arrival = barrier.arrive(0, et(5100), st(6000));
  ASSERT_TRUE(arrival.violation);
  EXPECT_EQ(arrival.violation->size, Duration(900));
  EXPECT_EQ(arrival.charged_at, et(6000));
  EXPECT_EQ(arrival.lag, Duration(0));
  EXPECT_FALSE(barrier.arrive(0, et(6000), st(6000)).violation);
}

TEST(Barrier, WhoHasLeftBoundsNothing) {
  auto barrier = with_suts({500, 200, 1900});
  request(barrier, 1, 300, 5300);
  EXPECT_EQ(barrier.lower_bound(), st(0));
  barrier.remove(0);
  EXPECT_EQ(barrier.lower_bound(), st(1000));
}

BarrierSynchronizer with_concurrent(std::int64_t start = 0) {
  BarrierSynchronizer barrier{StepGrid(kDt_1us)};
  barrier.add(et(start), SutKind::kConcurrent);
  return barrier;
}

void call(BarrierSynchronizer& barrier, CallId id, std::int64_t at, std::int64_t reply_at,
          std::int64_t now = 0) {
  barrier.arrive(0, et(at), st(now));
  barrier.hold({0, et(reply_at), id});
}

TEST(ConcurrentSut, BoundsStByItsOwnTimeAndByEachOpenCall) {
  auto barrier = with_concurrent(1200);
  EXPECT_EQ(barrier.lower_bound(), st(1000));
  call(barrier, 1, 2300, 7000);
  EXPECT_EQ(barrier.lower_bound(), st(2000));
  barrier.progress(0, et(6500));
  EXPECT_EQ(barrier.lower_bound(), st(6000));
  call(barrier, 2, 6600, 6700);
  barrier.stop(0, et(9000));
  EXPECT_EQ(barrier.lower_bound(), st(6000));
  ASSERT_TRUE(barrier.release(st(6000)));
  EXPECT_EQ(barrier.lower_bound(), st(7000));
  ASSERT_TRUE(barrier.release(st(7000)));
  EXPECT_EQ(barrier.lower_bound(), st(9000));
}

TEST(ConcurrentSut, GetsAReplyOnlyWhileItIsStoppedAtOrAfterItsTimestamp) {
  auto barrier = with_concurrent();
  call(barrier, 1, 300, 800);
  EXPECT_FALSE(barrier.release(st(0)));
  barrier.progress(0, et(900));
  EXPECT_FALSE(barrier.release(st(0)));
  barrier.stop(0, et(950));
  EXPECT_TRUE(barrier.is_held(0));
  const auto grant = barrier.release(st(0));
  ASSERT_TRUE(grant);
  EXPECT_EQ(grant->call, 1u);
  EXPECT_EQ(grant->resume_at, et(800));
  EXPECT_FALSE(barrier.is_held(0));
  EXPECT_EQ(barrier.bound(0), et(950));

  call(barrier, 2, 960, 990);
  barrier.stop(0, et(970));
  EXPECT_FALSE(barrier.is_held(0));
  EXPECT_FALSE(barrier.release(st(0)));
  barrier.stop(0, et(990));
  EXPECT_TRUE(barrier.release(st(0)));
}

// Its open calls do not make it a held SUT: it may still stamp an earlier command.
TEST(ConcurrentSut, DelaysOthersWhileItComputesWithAnOpenCall) {
  auto barrier = with_concurrent(3000);
  barrier.add(et(3000));
  call(barrier, 1, 3000, 9000, 3000);
  request(barrier, 1, 3000, 3400, 3000);
  EXPECT_FALSE(barrier.release(st(3000)));
  barrier.progress(0, et(3001));
  EXPECT_TRUE(barrier.release(st(3000)));
}

TEST(ConcurrentSut, LeavesWithItsOpenCalls) {
  auto barrier = with_concurrent();
  call(barrier, 1, 300, 800);
  barrier.remove(0);
  EXPECT_EQ(barrier.lower_bound(), SimTime::max());
  EXPECT_FALSE(barrier.release(st(0)));
}

}  // namespace
}  // namespace tether::sync
