#include "threads.h"

#include <atomic>
#include <chrono>
#include <thread>

#include <gtest/gtest.h>
#include <pthread.h>
#include <unistd.h>

#include <tether/os/machine.h>

namespace tether::as_is {
namespace {

TEST(AsIsThreads, AThreadAloneHasNoOthersToWaitFor) {
  EXPECT_FALSE(Threads::are_several());
  EXPECT_TRUE(Threads().are_others_waiting());
}

TEST(AsIsThreads, AThreadThatComputesIsSeen) {
  std::atomic<bool> stop = false;
  Threads::began();
  std::thread other([&stop] {
    while (!stop) {
    }
  });
  EXPECT_FALSE(Threads().are_others_waiting());
  stop = true;
  other.join();
  Threads::ended();
}

TEST(AsIsThreads, AThreadThatWaitsForAnotherIsSeen) {
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  Threads::began();
  std::thread other([&] {
    char byte = 0;
    static_cast<void>(::read(ends[0], &byte, 1));
  });
  // It may still begin.
  while (!Threads().are_others_waiting()) std::this_thread::yield();
  ASSERT_EQ(::write(ends[1], "x", 1), 1);
  other.join();
  Threads::ended();
  ::close(ends[0]);
  ::close(ends[1]);
}

TEST(AsIsThreads, NobodyIsWaitingWhileOneIsOutside) {
  const Threads::Outside outside;
  EXPECT_FALSE(Threads().are_others_waiting());
}

TEST(AsIsThreads, EachHasComputedByItsName) {
  std::thread busy([] {
    ::pthread_setname_np(::pthread_self(), "busy");
    const Duration begun = os::read_clock(CLOCK_THREAD_CPUTIME_ID);
    while (os::read_clock(CLOCK_THREAD_CPUTIME_ID) - begun < std::chrono::milliseconds(20)) {
    }
    EXPECT_GE(Threads::computed()["busy"], std::chrono::milliseconds(19));
  });
  busy.join();
  EXPECT_EQ(Threads::computed().count("busy"), 0U);
}

}  // namespace
}  // namespace tether::as_is
