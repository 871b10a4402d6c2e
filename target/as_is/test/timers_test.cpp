#include "timers.h"

#include "clocks.h"

#include <cerrno>
#include <csignal>

#include <gtest/gtest.h>
#include <poll.h>
#include <unistd.h>

namespace tether::as_is {
namespace {

using std::chrono::milliseconds;

class AsIsTimers : public testing::Test {
 protected:
  static ExecTime at(int ms) { return ExecTime(milliseconds(ms)); }
  static itimerspec spec(int first_ms, int interval_ms = 0) {
    return {to_timespec(milliseconds(interval_ms)), to_timespec(milliseconds(first_ms))};
  }
  static bool can_be_read(int fd) {
    pollfd one{fd, POLLIN, 0};
    return ::poll(&one, 1, 0) == 1;
  }
  /// Expiries since the last read; 0: EAGAIN.
  std::uint64_t taken(int fd) {
    std::uint64_t count = 0;
    if (timers_.take(fd, &count, sizeof count) == sizeof count) return count;
    EXPECT_EQ(errno, EAGAIN);
    return 0;
  }

  Timers timers_;
  int fd_ = timers_.create(CLOCK_MONOTONIC, TFD_CLOEXEC);
};

TEST_F(AsIsTimers, OneThatIsSetOnceExpiresOnce) {
  EXPECT_EQ(timers_.next(), std::nullopt);
  ASSERT_EQ(timers_.set(fd_, 0, spec(20), nullptr, at(100)), 0);
  EXPECT_EQ(timers_.next(), at(120));
  EXPECT_FALSE(timers_.fire(at(119)));
  EXPECT_FALSE(can_be_read(fd_));
  EXPECT_EQ(taken(fd_), 0U);
  EXPECT_TRUE(timers_.fire(at(120)));
  EXPECT_TRUE(can_be_read(fd_));
  EXPECT_EQ(taken(fd_), 1U);
  EXPECT_EQ(timers_.next(), std::nullopt);
  EXPECT_FALSE(timers_.fire(at(1000)));
  EXPECT_EQ(taken(fd_), 0U);
}

TEST_F(AsIsTimers, APeriodicOneCountsEachPeriodAndKeepsItsPhase) {
  ASSERT_EQ(timers_.set(fd_, 0, spec(10, 30), nullptr, at(0)), 0);
  EXPECT_TRUE(timers_.fire(at(10)));
  EXPECT_TRUE(timers_.fire(at(105)));  // 40, 70, 100
  EXPECT_EQ(taken(fd_), 4U);
  EXPECT_EQ(timers_.next(), at(130));
}

TEST_F(AsIsTimers, AnAbsoluteOneIsByItsClockAndExpiresAtOnceIfThatIsPast) {
  const int of_date = timers_.create(CLOCK_REALTIME, 0);
  const itimerspec later{{}, shown(CLOCK_REALTIME, at(500))};
  ASSERT_EQ(timers_.set(of_date, TFD_TIMER_ABSTIME, later, nullptr, at(100)), 0);
  EXPECT_EQ(timers_.next(), at(500));
  const itimerspec past{to_timespec(milliseconds(40)), shown(CLOCK_MONOTONIC, at(10))};
  ASSERT_EQ(timers_.set(fd_, TFD_TIMER_ABSTIME, past, nullptr, at(100)), 0);
  EXPECT_TRUE(timers_.fire(at(100)));
  EXPECT_EQ(taken(fd_), 3U);  // 10, 50, 90
}

TEST_F(AsIsTimers, TellsWhatIsLeftAndDropsWhatWasCounted) {
  itimerspec left{};
  ASSERT_EQ(timers_.set(fd_, 0, spec(20, 7), nullptr, at(0)), 0);
  ASSERT_EQ(timers_.get(fd_, &left, at(15)), 0);
  EXPECT_EQ(left.it_value.tv_nsec, 5'000'000);
  EXPECT_EQ(left.it_interval.tv_nsec, 7'000'000);
  // Of the next period, also if nobody looked since.
  ASSERT_EQ(timers_.set(fd_, 0, spec(0), &left, at(22)), 0);
  EXPECT_EQ(left.it_value.tv_nsec, 5'000'000);
  EXPECT_FALSE(can_be_read(fd_));
  ASSERT_EQ(timers_.get(fd_, &left, at(23)), 0);
  EXPECT_EQ(left.it_value.tv_nsec, 0);
  EXPECT_EQ(timers_.next(), std::nullopt);
}

TEST_F(AsIsTimers, LivesAsLongAsOneOfItsDescriptors) {
  const int copy = ::dup(fd_);
  timers_.copy(fd_, copy);
  ASSERT_EQ(timers_.set(copy, 0, spec(20), nullptr, at(0)), 0);
  timers_.forget(fd_);
  ::close(fd_);
  EXPECT_FALSE(timers_.is_ours(fd_));
  EXPECT_TRUE(timers_.fire(at(20)));
  EXPECT_EQ(taken(copy), 1U);
  ASSERT_EQ(timers_.set(copy, 0, spec(20), nullptr, at(20)), 0);
  timers_.forget(copy);
  EXPECT_EQ(timers_.next(), std::nullopt);
  EXPECT_FALSE(timers_.is_ours(copy));
  ::close(copy);
}

TEST_F(AsIsTimers, RefusesWhatTheKernelRefuses) {
  EXPECT_EQ(timers_.create(CLOCK_MONOTONIC, 1), -1);
  EXPECT_EQ(errno, EINVAL);
  itimerspec wrong = spec(20);
  wrong.it_value.tv_nsec = 1'000'000'000;
  for (const auto& [flags, value] : {std::pair(0, wrong), {8, spec(20)}}) {
    errno = 0;
    EXPECT_EQ(timers_.set(fd_, flags, value, nullptr, at(0)), -1);
    EXPECT_EQ(errno, EINVAL);
  }
  char little[4];
  EXPECT_EQ(timers_.take(fd_, little, sizeof little), -1);
  EXPECT_EQ(errno, EINVAL);
}

int g_signals = 0, g_overrun = 0;

TEST_F(AsIsTimers, OneThatIsNoDescriptorSendsItsSignal) {
  struct sigaction action {};
  action.sa_sigaction = [](int, siginfo_t* info, void*) {
    ++g_signals;
    g_overrun = info->si_overrun;
  };
  action.sa_flags = SA_SIGINFO;
  ::sigaction(SIGUSR2, &action, nullptr);
  sigevent event{};
  event.sigev_notify = SIGEV_SIGNAL;
  event.sigev_signo = SIGUSR2;
  const int timer = timers_.create(CLOCK_MONOTONIC, event);
  EXPECT_TRUE(timers_.is_ours(timer));
  EXPECT_FALSE(timers_.have_events());
  ASSERT_EQ(timers_.set(timer, 0, spec(10, 5), nullptr, at(0)), 0);
  EXPECT_TRUE(timers_.have_events());
  EXPECT_EQ(timers_.next(), at(10));
  timers_.fire(at(9));
  EXPECT_EQ(g_signals, 0);
  timers_.fire(at(10));
  EXPECT_EQ(g_signals, 1);
  timers_.fire(at(26));  // at 15, 20 and 25
  EXPECT_EQ(g_signals, 2);
  EXPECT_EQ(g_overrun, 2);
  EXPECT_EQ(timers_.overrun(timer), 2);
  timers_.forget(timer);
  EXPECT_FALSE(timers_.have_events());
  EXPECT_EQ(timers_.next(), std::nullopt);
  EXPECT_FALSE(timers_.is_ours(timer));
  ::signal(SIGUSR2, SIG_DFL);
}

TEST_F(AsIsTimers, OneThatStartsThreadsCallsWhoDoesThat) {
  static int started = 0;
  Timers starting([](const sigevent& event) { started = event.sigev_value.sival_int; });
  sigevent event{};
  event.sigev_notify = SIGEV_THREAD;
  event.sigev_value.sival_int = 7;
  const int timer = starting.create(CLOCK_MONOTONIC, event);
  ASSERT_EQ(starting.set(timer, TIMER_ABSTIME, spec(1'000'020), nullptr, at(0)), 0);
  EXPECT_EQ(starting.next(), at(20));
  starting.fire(at(20));
  EXPECT_EQ(started, 7);
}

}  // namespace
}  // namespace tether::as_is
