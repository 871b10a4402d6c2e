#include "convergence.h"

#include <gmock/gmock.h>

namespace tether::tasks {
namespace {

vision::Roi roi_at(double u_px, double size_px = 40) {
  vision::Roi roi;
  roi.center = {u_px, 100};
  roi.width_px = size_px;
  roi.height_px = size_px;
  return roi;
}

/// How many images it takes while the ROI moves by `step_px` between them; 0: more than 50.
int images_until_converged(double step_px, const ConvergenceOptions& options = {}) {
  ConvergenceMonitor monitor(options);
  for (int i = 0; i < 50; ++i) {
    monitor.see(from_ns<SimTime>(33'000'000 * i), roi_at(20 + step_px * i));
    if (monitor.has_converged()) return i + 1;
  }
  return 0;
}

TEST(Convergence, TakesOneImageMoreThanAreStableAndInFastMotionAnother) {
  EXPECT_EQ(images_until_converged(0), 3);
  EXPECT_EQ(images_until_converged(7), 3);
  EXPECT_EQ(images_until_converged(0, {.stable_frames = 4}), 5);
  EXPECT_EQ(images_until_converged(9), 4);
  EXPECT_EQ(images_until_converged(60), 4);
}

TEST(Convergence, StartsAgainWhenSpeedOrSizeChangesBeyondTheTolerance) {
  ConvergenceMonitor speed({}), size({});
  const double positions[] = {0, 20, 40, 90, 50, 120};
  for (int i = 0; i < 6; ++i) {
    speed.see(from_ns<SimTime>(33'000'000 * i), roi_at(positions[i]));
    size.see(from_ns<SimTime>(33'000'000 * i), roi_at(100, 20 + 10 * i));
    EXPECT_FALSE(speed.has_converged() || size.has_converged()) << i;
  }
}

TEST(Convergence, SpeedIsPerTimeNotPerImage) {
  // Uniform motion of 10 px per 10 ms, sampled unevenly.
  ConvergenceMonitor monitor({});
  for (const int ms : {0, 30, 130, 160}) {
    monitor.see(from_ns<SimTime>(1'000'000LL * ms), roi_at(ms));
  }
  EXPECT_TRUE(monitor.has_converged());
}

TEST(Convergence, AMissStartsItAnew) {
  ConvergenceMonitor monitor({});
  for (int i = 0; i < 2; ++i) monitor.see(from_ns<SimTime>(i), roi_at(100));
  monitor.miss();
  for (int i = 2; i < 4; ++i) {
    monitor.see(from_ns<SimTime>(i), roi_at(100));
    EXPECT_FALSE(monitor.has_converged());
  }
}

TEST(Convergence, TheSameImageTwiceIsNoMotion) {
  ConvergenceMonitor monitor({});
  for (int i = 0; i < 3; ++i) monitor.see(from_ns<SimTime>(5), roi_at(100));
  EXPECT_TRUE(monitor.has_converged());
}

}  // namespace
}  // namespace tether::tasks
