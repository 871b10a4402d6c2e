#include <condition_variable>
#include <csignal>
#include <filesystem>
#include <mutex>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/os/interrupt.h>
#include <tether/os/text_file.h>

/// A second signal that comes later: tests/system/run/interrupt_test.cpp.
namespace tether::os {
namespace {

void wait_for(const std::stop_token& token) {
  std::mutex mutex;
  std::unique_lock lock(mutex);
  std::condition_variable_any stopped;
  stopped.wait(lock, token, [&] { return token.stop_requested(); });
}

TEST(Interrupt, RequestsAStopOnSigintSigtermAndSighup) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
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
  for (const int signal : {SIGTERM, SIGHUP})
    EXPECT_EXIT(
        {
          { const Interrupt interrupt; }
          raise(signal);
        },
        testing::KilledBySignal(signal), "");
}

TEST(Interrupt, LeavesSighupIgnoredAsNohupWants) {
  std::signal(SIGHUP, SIG_IGN);
  {
    const Interrupt interrupt;
    raise(SIGHUP);
    EXPECT_EQ(std::signal(SIGHUP, SIG_IGN), SIG_IGN);
  }
  EXPECT_EQ(std::signal(SIGHUP, SIG_DFL), SIG_IGN);
}

TEST(Interrupt, TakesSignalsOfAPauseAfterIt) {
  const Interrupt interrupt;
  {
    const Interrupt::Pause pause;
    raise(SIGINT);
    EXPECT_FALSE(interrupt.token().stop_requested());
  }
  wait_for(interrupt.token());
  EXPECT_TRUE(interrupt.token().stop_requested());
}

TEST(Interrupt, EndsAtOnceWhereNothingElseCanBeStopped) {
  const ScratchFolder scratch;
  EXPECT_EXIT(
      {
        const Interrupt interrupt;
        const TemporaryFolder half_written("half-", scratch.path());
        { const Interrupt::EndsAtOnce passed; }
        const Interrupt::EndsAtOnce reading;
        raise(SIGTERM);
        for (;;) pause();
      },
      testing::ExitedWithCode(128 + SIGTERM), "");
  EXPECT_TRUE(std::filesystem::is_empty(scratch.path()));
  const Interrupt::EndsAtOnce alone;  // without an Interrupt
}

TEST(SleepUnlessStopped, EndsWithAStopRequest) {
  std::stop_source stop;
  stop.request_stop();
  sleep_unless_stopped(std::chrono::hours(1), stop.get_token());
  sleep_unless_stopped(Duration(1), {});
}

}  // namespace
}  // namespace tether::os
