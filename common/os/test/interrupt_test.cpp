#include <condition_variable>
#include <csignal>
#include <mutex>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <tether/os/interrupt.h>

/// A second signal that comes later: tests/system/run/interrupt_test.cpp.
namespace tether::os {
namespace {

void wait_for(const std::stop_token& token) {
  std::mutex mutex;
  std::unique_lock lock(mutex);
  std::condition_variable_any stopped;
  stopped.wait(lock, token, [&] { return token.stop_requested(); });
}

TEST(Interrupt, RequestsAStopOnSigintAndOnSigterm) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const Interrupt interrupt;
    EXPECT_FALSE(interrupt.token().stop_requested());
    raise(signal);
    wait_for(interrupt.token());
    EXPECT_TRUE(interrupt.token().stop_requested());
  }
}

TEST(Interrupt, TreatsSignalsInARowAsOneAndIgnoresSigpipe) {
  const Interrupt interrupt;
  for (const int signal : {SIGINT, SIGINT, SIGTERM}) raise(signal);
  wait_for(interrupt.token());
  EXPECT_TRUE(interrupt.token().stop_requested());
  Pipe pipe = make_pipe();
  pipe.read_end = FileDescriptor();
  EXPECT_FALSE(write_all(pipe.write_end, "text"));
}

TEST(Interrupt, LeavesSignalsAsTheyWereAfterItsEnd) {
  EXPECT_EXIT(
      {
        { const Interrupt interrupt; }
        raise(SIGTERM);
      },
      testing::KilledBySignal(SIGTERM), "");
}

}  // namespace
}  // namespace tether::os
