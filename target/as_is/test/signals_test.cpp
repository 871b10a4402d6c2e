#include "signals.h"

#include "real.h"
#include "unpaid.h"

#include <atomic>
#include <csignal>
#include <cstdint>

#include <gtest/gtest.h>
#include <sys/eventfd.h>
#include <unistd.h>

namespace tether::as_is {
namespace {

int g_ran = 0;
bool g_was_inside = false;

void handler(int) {
  ++g_ran;
  g_was_inside = Inside::is();
}

class AsIsSignals : public testing::Test {
 protected:
  AsIsSignals() {
    g_ran = 0;
    g_was_inside = false;
    struct sigaction action {};
    action.sa_handler = handler;
    EXPECT_EQ(Signals::set(SIGUSR1, &action, nullptr), 0);
  }
  ~AsIsSignals() override { std::signal(SIGUSR1, SIG_DFL); }
};

TEST_F(AsIsSignals, AHandlerRunsAtOnceUnlessTheLibraryWorks) {
  std::raise(SIGUSR1);
  EXPECT_EQ(g_ran, 1);
  {
    const Inside inside;
    {
      const Inside again;
      std::raise(SIGUSR1);
      std::raise(SIGUSR1);
    }
    EXPECT_EQ(g_ran, 1) << "the library holds what it may want";
  }
  EXPECT_EQ(g_ran, 3);
  EXPECT_FALSE(g_was_inside);
}

TEST_F(AsIsSignals, AWaitHearsThatAHandlerHasRun) {
  const Inside inside;
  const unsigned before = Signals::count();
  EXPECT_FALSE(Signals::have_run_since(before));
  {
    const Signals::Open open;
    std::raise(SIGUSR1);
    EXPECT_EQ(g_ran, 1) << "nothing is held";
    EXPECT_FALSE(g_was_inside);
    EXPECT_TRUE(Inside::is());
  }
  EXPECT_TRUE(Signals::have_run_since(before));
  const unsigned then = Signals::count();
  std::raise(SIGUSR1);
  EXPECT_EQ(g_ran, 1);
  EXPECT_TRUE(Signals::have_run_since(then));
  EXPECT_EQ(g_ran, 2);
}

// Between the last look and the kernel's wait: it would not end that one.
TEST_F(AsIsSignals, NobodyGoesOnBeforeAThreadHasSeenItsHandler) {
  const Inside inside;
  const int wake = ::eventfd(0, EFD_NONBLOCK);
  std::uint64_t count = 0;
  std::raise(SIGUSR1);
  EXPECT_EQ(g_ran, 0);
  {
    const Signals::Open open(wake);
    EXPECT_EQ(g_ran, 1) << "what came before runs before it waits";
    EXPECT_EQ(::read(wake, &count, sizeof count), ssize_t{sizeof count});
    std::raise(SIGUSR1);
    EXPECT_EQ(g_ran, 2);
    EXPECT_FALSE(Signals::are_seen());
    EXPECT_EQ(::read(wake, &count, sizeof count), ssize_t{sizeof count}) << "it does not wait";
  }
  EXPECT_TRUE(Signals::are_seen());
  std::atomic<int> shared = 0;
  Signals::count_unseen_in(shared);
  const Signals::Open open;
  std::raise(SIGUSR1);
  EXPECT_EQ(shared, 1);
  ::close(wake);
}

// What it computes is the program's, also while the library does not want to be paid.
TEST_F(AsIsSignals, AHandlerIsPaid) {
  class Counted final : public client::TimeSource {
   public:
    computer::Clock clock() const override { return {}; }
    Duration elapsed() const override { return now; }
    void leave_out(Duration computed) override { left_out += computed; }
    Duration counted_of_thread() const override { return now; }
    Duration now{0}, left_out{0};
  };
  static Counted source;
  struct sigaction action {};
  action.sa_handler = [](int) { source.now += Duration(100); };
  ASSERT_EQ(Signals::set(SIGUSR1, &action, nullptr), 0);
  const Inside inside;
  {
    const Unpaid unpaid(source);
    source.now += Duration(10);
    const Signals::Open open;
    std::raise(SIGUSR1);
    source.now += Duration(1);
  }
  EXPECT_EQ(source.left_out, Duration(11));
}

TEST_F(AsIsSignals, TheProgramSeesItsOwnHandlers) {
  struct sigaction old {};
  ASSERT_EQ(Signals::set(SIGUSR1, nullptr, &old), 0);
  EXPECT_EQ(old.sa_handler, handler);
  struct sigaction none {};
  none.sa_handler = SIG_IGN;
  ASSERT_EQ(Signals::set(SIGUSR1, &none, &old), 0);
  EXPECT_EQ(old.sa_handler, handler);
  std::raise(SIGUSR1);
  EXPECT_EQ(g_ran, 0);
  ASSERT_EQ(Signals::set(SIGUSR1, nullptr, &old), 0);
  EXPECT_EQ(old.sa_handler, SIG_IGN);
}

}  // namespace
}  // namespace tether::as_is
