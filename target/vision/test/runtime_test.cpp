#include <gmock/gmock.h>
#include <opencv2/core.hpp>

#include <tether/vision/anchor_tracker.h>

namespace tether::vision {
namespace {

TEST(Runtime, LimitsTheThreads) {
  set_threads(1);
  EXPECT_EQ(cv::getNumThreads(), 1);
}

TEST(Runtime, WarmsUpForAnyImageSize) {
  warm_up(640, 480);
  warm_up(32, 24);
}

}  // namespace
}  // namespace tether::vision
