#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include <tether/vision/anchor_tracker.h>

namespace tether::vision {
namespace {

uav::CameraSample drawn_image(int width_px, int height_px, int step) {
  uav::CameraSample image;
  image.width_px = width_px;
  image.height_px = height_px;
  image.rgb.assign(3 * static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px),
                   128);
  cv::Mat rgb(height_px, width_px, CV_8UC3, image.rgb.data());
  const int side = std::max(8, height_px / 6);
  cv::rectangle(rgb, cv::Rect(width_px / 3 + 3 * step, height_px / 3, side, side),
                cv::Scalar(20, 20, 230), cv::FILLED);
  return image;
}

}  // namespace

void set_threads(int count) {
  cv::setNumThreads(count);
}

void warm_up(int width_px, int height_px) {
  const uav::Anchor anchor{"warm-up", uav::AnchorShape::kBox, {1, 1, 1}, {0.1, 0.1, 0.9}};
  // More than one tracker, so that the allocator has settled on where to put such images.
  for (int round = 0; round < 3; ++round) {
    Result<AnchorTracker> tracker = AnchorTracker::create(anchor);
    for (int step = 0; tracker && step < 4; ++step) {
      (void)tracker->track(drawn_image(width_px, height_px, step));
    }
  }
}

}  // namespace tether::vision
