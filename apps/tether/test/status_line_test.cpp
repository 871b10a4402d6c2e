#include "terminal/status_line.h"

#include "terminal/progress_bar.h"

#include <gtest/gtest.h>

#include <tether/os/terminal.h>

/// On a real terminal: tests/system/run/terminal_test.cpp.
namespace tether::app {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(StatusLine, ShowsWhatFitsTheColumns) {
  coordinator::RunStatus status;
  EXPECT_EQ(to_line(status, 80), "waiting for the SUT to connect");
  EXPECT_EQ(to_line(status, 20), "waiting for the SU…");
  status.st = SimTime(milliseconds(1500));
  status.et = ExecTime(milliseconds(1512));
  status.wall = seconds(3);
  status.images = 8;
  status.interactions = 50;
  status.waiting_for = "uav1";
  EXPECT_EQ(to_line(status, 200),
            "ST   1.500 s  ET   1.512 s  lag   12.0 ms   0.50x real time  uav1 computing  "
            "50 interactions  8 frames");
  EXPECT_EQ(to_line(status, 60), "ST   1.500 s  ET   1.512 s  lag   12.0 ms   0.50x real time");
  EXPECT_EQ(to_line(status, 20), "ST   1.500 s");
}

TEST(ProgressBar, ShowsWhatFitsTheColumns) {
  const scenario::Scenario scenario = [] {
    scenario::Scenario named;
    named.name = "face_anchor";
    return named;
  }();
  scenario::Condition condition;
  condition.name = "target, no sync";
  campaign::TrialPlan plan;
  plan.scenario = &scenario;
  plan.condition = &condition;
  plan.seed = 3;
  campaign::CampaignProgress progress;
  progress.done = 3;
  progress.total = 10;
  progress.failed = 1;
  progress.time_left = seconds(72);
  progress.latest = &plan;
  EXPECT_EQ(to_line(progress, 200),
            "[#########.....................] 3/10  1 failed  1:12 left  "
            "face_anchor, target, no sync, seed 3");
  EXPECT_EQ(to_line(progress, 60), "[###.......] 3/10  1 failed  1:12 left  face_anchor, targe…");
  EXPECT_EQ(to_line(progress, 20), "3/10  1 failed  fa…");
}

}  // namespace
}  // namespace tether::app
