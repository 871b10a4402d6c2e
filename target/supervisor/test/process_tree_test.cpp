#include "process_tree.h"

#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tether::supervisor {
namespace {

using Pairs = std::set<std::pair<pid_t, pid_t>>;

std::vector<bool> rest(const std::vector<ProcessState>& processes, const Pairs& sharing = {}) {
  return at_rest(processes, [&sharing](pid_t parent, pid_t child) {
    return sharing.count({parent, child}) == 1;
  });
}

using Rest = std::vector<bool>;

TEST(AtRest, ProcessWithoutRunnableThreadsIsAtRest) {
  EXPECT_EQ(rest({{10, 1, 10, 0, 0}, {11, 10, 10, 1, 0}}), (Rest{true, false}));
  EXPECT_EQ(rest({{10, 1, 10, 0, 1}}), (Rest{false}));
}

TEST(AtRest, ParentInVforkOfStoppedChildIsAtRest) {
  const std::vector<ProcessState> stopped = {{10, 1, 10, 0, 1}, {11, 10, 10, 0, 0}};
  EXPECT_EQ(rest(stopped, {{10, 11}}), (Rest{true, true}));
  EXPECT_EQ(rest(stopped), (Rest{false, true}));  // the child runs a program of its own
  EXPECT_EQ(rest({{10, 1, 10, 0, 1}, {11, 10, 10, 1, 0}}, {{10, 11}}), (Rest{false, false}));
  EXPECT_EQ(rest({{10, 1, 10, 1, 1}, {11, 10, 10, 0, 0}}, {{10, 11}}), (Rest{false, true}));
}

TEST(AtRest, EachThreadInVforkNeedsAStoppedChild) {
  EXPECT_EQ(rest({{10, 1, 10, 0, 2}, {11, 10, 10, 0, 0}}, {{10, 11}}), (Rest{false, true}));
  EXPECT_EQ(rest({{10, 1, 10, 0, 2}, {11, 10, 10, 0, 0}, {12, 10, 10, 0, 0}}, {{10, 11}, {10, 12}}),
            (Rest{true, true, true}));
}

TEST(AtRest, FollowsVforkThroughSeveralGenerations) {
  const Pairs sharing = {{10, 11}, {11, 12}};
  EXPECT_EQ(rest({{10, 1, 10, 0, 1}, {11, 10, 10, 0, 1}, {12, 11, 10, 0, 0}}, sharing),
            (Rest{true, true, true}));
  EXPECT_EQ(rest({{10, 1, 10, 0, 1}, {11, 10, 10, 0, 1}, {12, 11, 10, 1, 0}}, sharing),
            (Rest{false, false, false}));
}

TEST(ProcessTree, ShowsAStoppedChildAndLeavesOneOut) {
  const pid_t child = ::fork();
  if (child == 0) {
    ::raise(SIGSTOP);
    ::_exit(0);
  }
  siginfo_t info{};
  ASSERT_EQ(::waitid(P_PID, static_cast<id_t>(child), &info, WSTOPPED | WNOWAIT), 0);
  const auto found = ProcessTree(-1).look();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].id, child);
  EXPECT_EQ(found[0].parent, ::getpid());
  EXPECT_EQ(found[0].group, ::getpgrp());
  EXPECT_EQ(rest(found), (Rest{true}));
  EXPECT_TRUE(ProcessTree(child).look().empty());
  ProcessTree(-1).kill_all();
  EXPECT_TRUE(ProcessTree(-1).look().empty());
}

}  // namespace
}  // namespace tether::supervisor
