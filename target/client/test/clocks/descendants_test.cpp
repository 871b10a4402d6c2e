#include <algorithm>
#include <atomic>
#include <csignal>
#include <functional>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <tether/base_testing/sanitizer.h>
#include <tether/client/sut_clock.h>
#include <tether/os/file_descriptor.h>
#include <tether/os/process_table.h>

/// The CPU clock with real processes.
namespace tether::client {
namespace {

using std::chrono::milliseconds;

constexpr Duration kWork = milliseconds(100);

Duration cpu(clockid_t clock) {
  timespec t{};
  ::clock_gettime(clock, &t);
  return std::chrono::seconds(t.tv_sec) + Duration(t.tv_nsec);
}

void work(Duration duration) {
  const Duration end = cpu(CLOCK_THREAD_CPUTIME_ID) + duration;
  while (cpu(CLOCK_THREAD_CPUTIME_ID) < end) continue;
}

pid_t start(const std::function<void()>& program) {
  const pid_t child = ::fork();
  if (child != 0) return child;
  program();
  ::_exit(0);
}

class CpuOfDescendants : public testing::Test {
 protected:
  ~CpuOfDescendants() override { end_all(); }
  /// Children of a child that ends become its children.
  static void end_all() {
    do {
      for (const pid_t child : os::children_of(::getpid())) ::kill(child, SIGKILL);
    } while (::waitpid(-1, nullptr, 0) > 0);
  }
  /// In a descendant: it has done its work, and lives on.
  void stay() const {
    static_cast<void>(!::write(pipe_.write_end.get(), "x", 1));
    ::pause();
  }
  void await_stay() const {
    char byte = 0;
    ASSERT_EQ(::read(pipe_.read_end.get(), &byte, 1), 1);
  }
  Duration measured() const { return source_->elapsed() - begin_; }

  os::Pipe pipe_ = os::make_pipe();
  std::unique_ptr<TimeSource> source_ = make_cpu_source(1.0);
  Duration begin_ = source_->elapsed();
};

TEST_F(CpuOfDescendants, IsCountedOnceWhoeverUsedIt) {
  const struct {
    const char* what;
    std::function<void()> run;
    Duration late{0};  // how much is not known before the end
  } cases[] = {
      {"a child that was waited for", [] { ::waitpid(start([] { work(kWork); }), nullptr, 0); }},
      {"a child that has ended and was not waited for",
       [] {
         siginfo_t ended{};
         const pid_t child = start([] { work(kWork); });
         ::waitid(P_PID, static_cast<id_t>(child), &ended, WEXITED | WNOWAIT);
       }},
      {"a living child",
       [this] {
         start([this] { work(kWork), stay(); });
         await_stay();
       }},
      {"a living child of a child",
       [this] {
         start([this] { start([this] { work(kWork), stay(); }), ::pause(); });
         await_stay();
       }},
      {"a child for which a living child has waited",
       [this] {
         start([this] {
           ::waitpid(start([] { work(kWork); }), nullptr, 0);
           stay();
         });
         await_stay();
       },
       milliseconds(20)},
      {"a daemon in a session of its own",
       [this] {
         const auto daemon = [this] { ::setsid(), work(kWork), stay(); };
         ::waitpid(start([&] { start(daemon); }), nullptr, 0);
         await_stay();
       }},
      {"children of several threads",
       [] {
         std::vector<std::thread> threads;
         for (int i = 0; i < 4; ++i)
           threads.emplace_back([] { ::waitpid(start([] { work(kWork / 4); }), nullptr, 0); });
         for (auto& thread : threads) thread.join();
       }},
  };
  // What starting processes takes: less than counting anything twice would add.
  constexpr bool kIsSanitized = TETHER_ADDRESS_SANITIZER || TETHER_THREAD_SANITIZER;
  constexpr Duration kStarts = milliseconds(kIsSanitized ? 500 : 90);
  for (const auto& c : cases) {
    begin_ = source_->elapsed();
    c.run();
    EXPECT_GE(measured(), kWork - c.late) << c.what;
    EXPECT_LE(measured(), kWork + kStarts) << c.what;
    end_all();
    EXPECT_GE(measured(), kWork) << c.what;
    EXPECT_LE(measured(), kWork + kStarts) << c.what;
    EXPECT_TRUE(source_->complete());
  }
}

// Children that end and are waited for by another thread while the clock is read.
TEST_F(CpuOfDescendants, IsMonotoneAndNeverCountedTwice) {
  const auto used = [] {
    rusage children{};
    ::getrusage(RUSAGE_CHILDREN, &children);
    return cpu(CLOCK_PROCESS_CPUTIME_ID) + std::chrono::seconds(children.ru_utime.tv_sec) +
           std::chrono::seconds(children.ru_stime.tv_sec) +
           std::chrono::microseconds(children.ru_utime.tv_usec + children.ru_stime.tv_usec);
  };
  const Duration used_before = used();
  begin_ = source_->elapsed();
  std::atomic<bool> done = false;
  std::thread parent([&done] {
    for (int i = 0; i < 50; ++i) {
      const auto child = [] { ::waitpid(start([] { work(milliseconds(1)); }), nullptr, 0); };
      ::waitpid(start(child), nullptr, 0);
    }
    done = true;
  });
  for (Duration last = begin_; !done;) {
    const Duration now = source_->elapsed();
    EXPECT_GE(now, last);
    last = now;
  }
  parent.join();
  EXPECT_GE(measured(), 50 * milliseconds(1));
  EXPECT_LE(measured(), used() - used_before + milliseconds(1));
  EXPECT_LE(source_->elapsed_in_children(), used());
}

TEST_F(CpuOfDescendants, AreLookedAtForFree) {
  for (int i = 0; i < 8; ++i) {
    start([this] { stay(); });
    await_stay();
  }
  begin_ = source_->elapsed();
  const Duration before = cpu(CLOCK_THREAD_CPUTIME_ID);
  for (int i = 0; i < 200; ++i) source_->elapsed();
  EXPECT_LT(2 * measured(), cpu(CLOCK_THREAD_CPUTIME_ID) - before);
}

TEST_F(CpuOfDescendants, AreNotLookedAtForLessThanNothing) {
  start([this] { stay(); });
  await_stay();
  begin_ = source_->elapsed();
  const Duration counted_before = source_->counted_of_thread();
  for (int i = 0; i < 500; ++i) source_->elapsed();
  source_->leave_out(source_->counted_of_thread() - counted_before);
  work(milliseconds(5));
  EXPECT_GE(measured(), milliseconds(5));
}

TEST_F(CpuOfDescendants, IsIncompleteIfAProcessIgnoresTheEndOfChildren) {
  EXPECT_TRUE(source_->complete());
  struct sigaction keeps {
  }, before{};
  for (const int flags : {0, SA_NOCLDWAIT}) {
    keeps.sa_handler = flags == 0 ? SIG_IGN : SIG_DFL;
    keeps.sa_flags = flags;
    ::sigaction(SIGCHLD, &keeps, &before);
    EXPECT_EQ(source_->complete().failure().kind, Failure::Kind::kRefused);
    ::sigaction(SIGCHLD, &before, nullptr);
    EXPECT_TRUE(source_->complete());
  }
  start([this] { ::signal(SIGCHLD, SIG_IGN), stay(); });
  await_stay();
  source_->elapsed();
  EXPECT_EQ(source_->complete().failure().kind, Failure::Kind::kRefused);
}

}  // namespace
}  // namespace tether::client
