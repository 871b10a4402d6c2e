#include <chrono>
#include <csignal>
#include <thread>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/client/exec/group_page.h>

namespace tether::client {
namespace {

using namespace std::chrono_literals;

/// Until this thread has computed for so long.
void compute_here(Duration duration) {
  timespec begin{}, now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &begin);
  do {
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  } while (std::chrono::seconds(now.tv_sec - begin.tv_sec) + Duration(now.tv_nsec - begin.tv_nsec) <
           duration);
}

class GroupPageTest : public testing::Test {
 protected:
  std::string file() const { return (scratch_.path() / "page").string(); }

  ScratchFolder scratch_;
  MappedGroupPage page_ = std::move(make_group_page(file())).value();
};

TEST_F(GroupPageTest, IsTheSameMemoryForEachThatMapsIt) {
  const MappedGroupPage other = std::move(map_group_page(file())).value();
  page_->publish(ExecTime(3s), page_->used(), 2.0);
  EXPECT_EQ(other->now(), ExecTime(3s));
  EXPECT_FALSE(make_group_page(file())) << "there is one";
  EXPECT_FALSE(map_group_page(scratch_.write("short", "x")));
  EXPECT_FALSE(map_group_page("/nowhere/page"));
}

TEST_F(GroupPageTest, ExecutionTimeIsTheCpuTimeOfAllProcessesTimesTheFactor) {
  ASSERT_NE(page_->enter(::getpid()), nullptr);
  EXPECT_EQ(page_->enter(::getpid()), page_->enter(::getpid())) << "counted once";
  page_->publish(ExecTime(1s), page_->used(), 10.0);
  const ExecTime begin = page_->now();
  compute_here(20ms);
  EXPECT_GE(page_->now() - begin, 200ms);
  EXPECT_LT(page_->now() - begin, 300ms);
  std::this_thread::sleep_for(50ms);
  EXPECT_LT(page_->now() - begin, 300ms) << "it has waited";
  const ExecTime before = page_->now();
  page_->leave_out(1h);
  EXPECT_EQ(page_->now(), before) << "and does not go back";
}

TEST_F(GroupPageTest, WhatAnEndedProcessHasComputedStays) {
  Computed computed;
  const pid_t child = ::fork();
  if (child == 0) {
    page_->enter(::getpid())->call("a child");
    compute_here(30ms);
    page_->begin_wait(::getpid(), ExecTime(1s));
    ::_exit(page_->used() >= 30ms ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
  EXPECT_GE(page_->used(), 30ms);
  EXPECT_EQ(page_->first_deadline(), ExecTime(1s));
  page_->add_present(computed);
  EXPECT_GE(computed["a child"], 30ms);
  computed.clear();
  page_->forget_ended(computed);
  EXPECT_GE(computed["a child"], 30ms);
  EXPECT_GE(page_->used(), 30ms);
  EXPECT_LT(page_->used(), 60ms);
  EXPECT_EQ(page_->first_deadline(), GroupPage::kNever) << "it waits no more";
  for (const auto& process : page_->processes()) EXPECT_EQ(process.id, 0);
}

TEST_F(GroupPageTest, HasTheFirstDeadlineOfAllWaitsAndTimers) {
  EXPECT_EQ(page_->first_deadline(), GroupPage::kNever);
  GroupPage::Process* const own = page_->enter(::getpid());
  GroupPage::Wait* const late = page_->begin_wait(::getpid(), ExecTime(3s));
  GroupPage::Wait* const early = page_->begin_wait(1, ExecTime(2s));
  EXPECT_EQ(page_->first_deadline(), ExecTime(2s));
  own->timer = ExecTime(1s);
  EXPECT_EQ(page_->first_deadline(), ExecTime(1s));
  own->timer = GroupPage::kNever;
  GroupPage::end_wait(early);
  EXPECT_EQ(page_->first_deadline(), ExecTime(3s));
  GroupPage::end_wait(late);
  EXPECT_EQ(page_->first_deadline(), GroupPage::kNever);
  EXPECT_EQ(page_->begin_wait(1, ExecTime(2s)), late) << "its place is free";
  page_->begin_again(1);
  EXPECT_EQ(page_->first_deadline(), GroupPage::kNever);
}

TEST_F(GroupPageTest, HasThreadsUntilTheyEndOrTheirProcessBeginsAgain) {
  page_->enter(7);
  EXPECT_TRUE(page_->has(7));
  GroupPage::Thread* const other = page_->begin_thread(7, GroupPage::kBegins);
  ASSERT_EQ(page_->threads().size(), 2U);
  EXPECT_EQ(page_->threads()[0].id, 7);
  page_->begin_again(7);
  EXPECT_EQ(page_->threads()[0].id, 7);
  EXPECT_EQ(other->id, 0);
  EXPECT_EQ(page_->begin_thread(8, 9), other) << "its place is free";
  GroupPage::end_thread(other);
  EXPECT_EQ(other->id, 0);
  EXPECT_FALSE(page_->has(8));
}

// Who is told before it waits is told again; who waits for a mutex after its deadline does not keep
// the others waiting.
TEST_F(GroupPageTest, TellsThoseThatAreOverdueSomeTimes) {
  page_->begin_wait(7, ExecTime(2s));
  EXPECT_FALSE(page_->tell_overdue(7, ExecTime(1s), 0s, 1s));
  EXPECT_FALSE(page_->tell_overdue(8, ExecTime(2s), 0s, 1s));
  EXPECT_TRUE(page_->tell_overdue(7, ExecTime(2s), 0s, 1s));
  EXPECT_FALSE(page_->tell_overdue(7, ExecTime(2s), 999ms, 1001ms)) << "just told";
  EXPECT_EQ(page_->first_deadline(), ExecTime(2s));
  EXPECT_TRUE(page_->tell_overdue(7, ExecTime(2s), 1s, 2s));
  EXPECT_TRUE(page_->tell_overdue(7, ExecTime(2s), 2s, 3s));
  EXPECT_FALSE(page_->tell_overdue(7, ExecTime(2s), 3s, 4s));
  EXPECT_EQ(page_->first_deadline(), GroupPage::kNever);
}

TEST_F(GroupPageTest, ItsSourceIsACpuClockWhoseTimeIsThatOfChildren) {
  page_->enter(::getpid());
  const auto source = make_group_source(*page_, 4.0);
  EXPECT_EQ(source->clock(), (computer::Clock{computer::ClockKind::kCpu, 4.0}));
  const Duration before = source->elapsed(), own = source->counted_of_thread();
  compute_here(5ms);
  EXPECT_GE(source->elapsed() - before, 20ms);
  EXPECT_GE(source->elapsed_in_children() - before, 20ms);
  source->leave_out(source->counted_of_thread() - own);
  EXPECT_LT(source->counted_of_thread() - own, 1ms);
}

}  // namespace
}  // namespace tether::client
