#include "thread_files.h"

#include <chrono>
#include <csignal>
#include <vector>

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/os/process_table.h>

/// Whole programs fly in the system test as_is_group_test.
namespace tether::supervisor {
namespace {

class ThreadFilesTest : public testing::Test {
 protected:
  ThreadFilesTest() {
    cpu_set_t core;
    CPU_ZERO(&core);
    CPU_SET(static_cast<std::size_t>(::sched_getcpu()), &core);
    ::sched_setaffinity(0, sizeof core, &core);
  }
  ~ThreadFilesTest() override {
    for (const pid_t child : children_) ::kill(child, SIGKILL);
    while (::waitpid(-1, nullptr, 0) > 0) continue;
    ::sched_setaffinity(0, sizeof before_, &before_);
  }

  static cpu_set_t allowed() {
    cpu_set_t cores;
    ::sched_getaffinity(0, sizeof cores, &cores);
    return cores;
  }
  template <class Life>
  pid_t child(Life life) {
    const pid_t child = ::fork();
    if (child == 0) {
      life();
      ::_exit(0);
    }
    children_.push_back(child);
    return child;
  }
  static void compute_for_ever() {
    for (volatile bool for_ever = true; for_ever;) continue;
  }
  /// Within a second.
  bool become_waiting() {
    for (int i = 0; i < 1000; ++i) {
      if (files_.are_all_waiting(*page_)) return true;
      ::usleep(1000);
    }
    return false;
  }

  cpu_set_t before_ = allowed();
  ScratchFolder scratch_;
  client::MappedGroupPage page_ =
      std::move(client::make_group_page((scratch_.path() / "page").string())).value();
  ThreadFiles files_{0};
  std::vector<pid_t> children_;
};

TEST_F(ThreadFilesTest, SeesWhetherTheThreadsInThePageWait) {
  auto* const process = page_->enter(child([] { ::pause(); }));
  EXPECT_TRUE(become_waiting());
  process->unseen = 1;
  EXPECT_FALSE(files_.are_all_waiting(*page_)) << "it has to hear of a signal first";
  process->unseen = 0;
  EXPECT_TRUE(become_waiting());
  const pid_t computes = child(compute_for_ever);
  page_->enter(computes);
  for (int i = 0; i < 100; ++i) {
    EXPECT_FALSE(files_.are_all_waiting(*page_));
    ::usleep(100);
  }
  ::kill(computes, SIGSTOP);
  EXPECT_TRUE(become_waiting()) << "nothing happens there until somebody else acts";
  ::kill(computes, SIGKILL);
  ::waitpid(computes, nullptr, 0);
  EXPECT_TRUE(become_waiting());
}

TEST_F(ThreadFilesTest, AProcessThatWasKilledDoesNotWaitBeforeItsParentNoticesThat) {
  const pid_t killed = child([] { ::pause(); });
  page_->enter(killed);
  page_->begin_wait(killed, ExecTime(Duration(1)));
  EXPECT_TRUE(become_waiting());
  EXPECT_EQ(page_->first_deadline(), ExecTime(Duration(1)));
  ::kill(killed, SIGKILL);
  siginfo_t info{};
  ::waitid(P_PID, static_cast<id_t>(killed), &info, WEXITED | WNOWAIT);
  EXPECT_TRUE(become_waiting());
  EXPECT_EQ(page_->first_deadline(), client::GroupPage::kNever);
}

TEST_F(ThreadFilesTest, AThreadThatBeginsDoesNotWait) {
  client::GroupPage::Thread* const thread =
      page_->begin_thread(::getpid(), client::GroupPage::kBegins);
  EXPECT_FALSE(files_.are_all_waiting(*page_));
  client::GroupPage::end_thread(thread);
  EXPECT_TRUE(become_waiting());
}

// It was started by one that is, or by one that has ended, and has not registered itself yet.
TEST_F(ThreadFilesTest, SeesChildrenThatAreNotInThePage) {
  const pid_t parent = child([this] {
    child(compute_for_ever);
    ::pause();
  });
  page_->enter(parent);
  ::usleep(50'000);
  EXPECT_FALSE(files_.are_all_waiting(*page_));
  const std::vector<pid_t> found = os::children_of(parent);
  ASSERT_EQ(found.size(), 1U);
  ::kill(found[0], SIGSTOP);
  EXPECT_TRUE(become_waiting());
  EXPECT_TRUE(page_->has(found[0])) << "it is charged";
  ::kill(found[0], SIGKILL);
  child(compute_for_ever);
  EXPECT_FALSE(files_.are_all_waiting(*page_));
}

}  // namespace
}  // namespace tether::supervisor
