#include "signals.h"

#include "real.h"

#include <csignal>

#include <gtest/gtest.h>

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
