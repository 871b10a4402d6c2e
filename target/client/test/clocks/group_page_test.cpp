#include <chrono>
#include <csignal>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <sched.h>
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
}

TEST_F(GroupPageTest, WhatIsLeftOutIsNotChargedUnlessItWasRead) {
  GroupPage::Process& own = *page_->enter(::getpid());
  page_->publish(ExecTime{}, page_->used(), 1.0);
  const ExecTime before = page_->now();
  compute_here(20ms);
  page_->leave_out(own, 20ms, 0ms);
  EXPECT_LT(page_->now() - before, 10ms);
  compute_here(20ms);
  EXPECT_GE(page_->glance() - before, 20ms);
  page_->leave_out(own, 20ms, 0ms);
  EXPECT_LT(page_->now() - before, 10ms) << "a glance fixes nothing";
  compute_here(20ms);
  EXPECT_GE(page_->now() - before, 20ms);
  page_->leave_out(own, 20ms, 0ms);
  const ExecTime then = page_->now();
  EXPECT_GE(then - before, 20ms) << "it does not go back";
  compute_here(20ms);
  EXPECT_GE(page_->now() - then, 20ms) << "nor is free what comes next";
  compute_here(20ms);
  page_->leave_out(own, 20ms, 15ms);
  EXPECT_GE(page_->now() - then, 35ms) << "what another thread has computed is not left out";
}

// On one core, processes compute for the program and, now and then, for the library. Whenever they
// lose the core to each other, and whoever looks: all of the program's is charged, once, as soon
// as it was spent.
TEST_F(GroupPageTest, EachNanosecondOfTheProgramIsChargedOnceAsSoonAsItWasSpent) {
  cpu_set_t before, one;
  ASSERT_EQ(::sched_getaffinity(0, sizeof before, &before), 0);
  CPU_ZERO(&one);
  CPU_SET(static_cast<std::size_t>(::sched_getcpu()), &one);
  ASSERT_EQ(::sched_setaffinity(0, sizeof one, &one), 0);
  page_->enter(::getpid());
  page_->publish(ExecTime{}, page_->used(), 1.0);
  const Duration begun = page_->used();
  const auto drawn = [](int who, int i) { return 1ms + 200us * ((i * 7 + who * 3) % 10); };
  std::vector<pid_t> children;
  for (const int who : {1, 2}) {
    const pid_t child = ::fork();
    children.push_back(child);
    if (child != 0) continue;
    GroupPage::Process& own = *page_->enter(::getpid());
    for (int i = 0; i < 10'000; ++i) {
      compute_here(drawn(who, i));
      if (i % 3 != 0) page_->leave_out(own, drawn(who, i), 0ms);
      if (i % 4 == 0) static_cast<void>(page_->now());
    }
    ::_exit(0);
  }
  Duration computed{0};
  for (int i = 0; i < 100; ++i) {
    const ExecTime begin = page_->now();
    compute_here(drawn(0, i));
    computed += drawn(0, i);
    EXPECT_GE(page_->now() - begin, drawn(0, i)) << i;
  }
  for (const pid_t child : children) ::kill(child, SIGSTOP);
  for (const pid_t child : children) ::waitpid(child, nullptr, WUNTRACED);
  EXPECT_GE(page_->used() - begun, computed);
  Duration all{0};
  for (const auto& process : page_->processes()) all += Duration(process.used_ns);
  EXPECT_LE(page_->used(), all) << "nothing is charged twice";
  EXPECT_LT(page_->used(), all - 10ms) << "and most of the library's is left out";
  for (const pid_t child : children) ::kill(child, SIGKILL);
  for (const pid_t child : children) ::waitpid(child, nullptr, 0);
  ::sched_setaffinity(0, sizeof before, &before);
}

TEST_F(GroupPageTest, WhatACallDoesNotChargeIsReadOnce) {
  page_->enter(::getpid());
  const auto source = make_group_source(*page_, 2.0);
  const Duration at_hold = source->elapsed();
  compute_here(5ms);
  EXPECT_EQ(source->elapsed_in_children(), at_hold) << "of the instant of the hold";
  EXPECT_GE(source->elapsed(), at_hold + 10ms);
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
  GroupPage::Process* const process = page_->enter(::getpid());
  const auto source = make_group_source(*page_, 4.0, process);
  EXPECT_EQ(source->clock(), (computer::Clock{computer::ClockKind::kCpu, 4.0}));
  const Duration before = source->elapsed();
  compute_here(5ms);
  EXPECT_GE(source->elapsed() - before, 20ms);
  EXPECT_GE(source->elapsed_in_children() - before, 20ms);
  const Duration then = source->elapsed(), own = source->begin_to_leave_out();
  compute_here(5ms);
  source->leave_out(source->counted_of_thread() - own);
  EXPECT_LT(source->elapsed() - then, 4ms);
}

// A thread that is not excluded computes beside it: that one's is not left out.
TEST_F(GroupPageTest, ItsSourceLeavesOutNothingOfOtherThreads) {
  GroupPage::Process* const process = page_->enter(::getpid());
  const auto source = make_group_source(*page_, 1.0, process);
  const Duration before = source->elapsed(), own = source->begin_to_leave_out();
  static_cast<void>(source->elapsed());
  std::thread([] { compute_here(20ms); }).join();
  compute_here(20ms);
  static_cast<void>(source->elapsed());
  source->leave_out(source->counted_of_thread() - own);
  EXPECT_GE(source->elapsed() - before, 40ms);
}

}  // namespace
}  // namespace tether::client
