#include <cmath>

#include <gmock/gmock.h>
#include <opencv2/imgproc.hpp>

#include <tether/base/random.h>
#include <tether/vision/anchor_tracker.h>

namespace tether::vision {
namespace {

const uav::Anchor kTracked{"cube", uav::AnchorShape::kBox, {0.4, 0.4, 0.4}, {0.1, 0.2, 0.9}};
const cv::Scalar kBlue(25, 51, 230);

/// A drawn image: grey wall, brown floor.
class Picture {
 public:
  explicit Picture(int width_px = 320, int height_px = 240) {
    sample_.width_px = width_px;
    sample_.height_px = height_px;
    sample_.rgb.resize(3 * static_cast<std::size_t>(width_px * height_px));
    rgb() = cv::Scalar(150, 148, 145);
    fill({0, 3 * height_px / 4, width_px, height_px / 4}, {110, 90, 70});
  }
  Picture& fill(const cv::Rect& where, const cv::Scalar& color) {
    cv::Mat image = rgb();
    cv::rectangle(image, where, color, cv::FILLED);
    return *this;
  }
  Picture& add_noise(double stddev, std::uint64_t index) {
    KeyedRandom random({11, 0, index});
    for (std::uint8_t& byte : sample_.rgb) {
      byte = cv::saturate_cast<std::uint8_t>(byte + stddev * random.normal());
    }
    return *this;
  }
  /// The four bars of a gate whose side is `side`, rolled about its middle.
  Picture& add_gate(const cv::Point2f& middle, float side, float roll_deg) {
    cv::Mat image = rgb();
    for (const float edge : {side, 0.8F * side}) {
      cv::Point2f corners[4];
      cv::RotatedRect(middle, {edge, edge}, roll_deg).points(corners);
      std::vector<cv::Point> outline(corners, corners + 4);
      cv::fillConvexPoly(image, outline, edge == side ? kBlue : cv::Scalar(150, 148, 145));
    }
    return *this;
  }
  const uav::CameraSample& sample() const { return sample_; }

 private:
  cv::Mat rgb() { return {sample_.height_px, sample_.width_px, CV_8UC3, sample_.rgb.data()}; }
  uav::CameraSample sample_;
};

AnchorTracker tracker(const TrackerOptions& options = {}) {
  Result<AnchorTracker> created = AnchorTracker::create(kTracked, options);
  return std::move(created).value();
}

TEST(AnchorTracker, FindsTheAnchorInTheWholeImage) {
  AnchorTracker t = tracker();
  const auto roi = t.track(Picture().fill({200, 60, 41, 41}, kBlue).sample());
  ASSERT_TRUE(roi);
  EXPECT_NEAR(roi->center.u_px, 220, 0.3);
  EXPECT_NEAR(roi->center.v_px, 80, 0.3);
  EXPECT_NEAR(roi->width_px, 41, 3);
  EXPECT_NEAR(roi->height_px, 41, 3);
  EXPECT_NEAR(roi->edge_height_px, 41, 0.5);
  EXPECT_GT(roi->score, 0.8);
  EXPECT_TRUE(roi->searched_for);
}

TEST(AnchorTracker, FollowsFromTheLastWindow) {
  AnchorTracker t = tracker();
  for (int i = 0; i < 30; ++i) {
    const int u = 40 + 7 * i;
    const int v = 60 + (i % 5);
    const auto roi = t.track(Picture().fill({u, v, 31, 31}, kBlue).sample());
    ASSERT_TRUE(roi) << i;
    EXPECT_NEAR(roi->center.u_px, u + 15, 0.5);
    EXPECT_NEAR(roi->center.v_px, v + 15, 0.5);
    EXPECT_EQ(roi->searched_for, i == 0);
  }
}

TEST(AnchorTracker, FindsNothingInImageWithoutTheAnchor) {
  AnchorTracker t = tracker();
  EXPECT_FALSE(t.track(Picture().sample()));
  EXPECT_FALSE(t.track(Picture().fill({100, 100, 40, 40}, {200, 40, 30}).sample())) << "red";
  EXPECT_FALSE(t.track(Picture().fill({100, 100, 3, 3}, kBlue).sample())) << "too small";
}

TEST(AnchorTracker, NoticesLossAndFindsTheAnchorAgainElsewhere) {
  AnchorTracker t = tracker();
  ASSERT_TRUE(t.track(Picture().fill({30, 60, 31, 31}, kBlue).sample()));
  EXPECT_FALSE(t.track(Picture().sample()));
  EXPECT_FALSE(t.track(Picture().sample()));
  const auto again = t.track(Picture().fill({250, 90, 31, 31}, kBlue).sample());
  ASSERT_TRUE(again);
  EXPECT_NEAR(again->center.u_px, 265, 0.5);
  EXPECT_TRUE(again->searched_for);
  const auto jumped = t.track(Picture().fill({30, 60, 31, 31}, kBlue).sample());
  ASSERT_TRUE(jumped) << "a jump out of the window costs no image";
  EXPECT_NEAR(jumped->center.u_px, 45, 0.5);
  t.reset();
  EXPECT_TRUE(t.track(Picture().fill({30, 60, 31, 31}, kBlue).sample())->searched_for);
}

TEST(AnchorTracker, IsNotDistractedByClutter) {
  AnchorTracker t = tracker();
  const auto scene = [](int u) {
    return Picture()
        .fill({0, 200, 320, 12}, {40, 70, 210})  // a blue skirting board
        .fill({120, 20, 60, 50}, {200, 60, 40})  // a red picture
        .fill({270, 40, 30, 60}, {60, 160, 70})  // a plant
        .fill({20, 30, 50, 60}, {95, 100, 130})  // a bluish grey door
        .fill({u, 100, 36, 36}, kBlue);
  };
  for (int u = 60; u < 260; u += 9) {
    const auto roi = t.track(scene(u).sample());
    ASSERT_TRUE(roi) << u;
    EXPECT_NEAR(roi->center.u_px, u + 17.5, 1.0);
    EXPECT_NEAR(roi->center.v_px, 117.5, 1.0);
  }
}

TEST(AnchorTracker, PrefersTheBetterShapeToTheLargerOne) {
  AnchorTracker t = tracker();
  const auto roi =
      t.track(Picture().fill({10, 10, 300, 30}, kBlue).fill({150, 100, 40, 40}, kBlue).sample());
  ASSERT_TRUE(roi);
  EXPECT_NEAR(roi->center.v_px, 119.5, 1.0);
}

// A gate's upper and lower bars are a fifth of what its sides are in the profile of the columns.
TEST(AnchorTracker, FollowsAGateAsAWhole) {
  TrackerOptions options;
  options.is_hollow = true;
  AnchorTracker t = tracker(options);
  for (int i = 0; i < 40; ++i) {
    const float roll_deg = 20.0F * std::sin(0.4F * static_cast<float>(i));
    const float side = 40.0F + 2.0F * static_cast<float>(i);
    const float middle_u = 130.0F + static_cast<float>(i);
    const double roll_rad = std::abs(roll_deg) * CV_PI / 180.0;
    const double extent_px = side * (std::cos(roll_rad) + std::sin(roll_rad));
    const auto roi =
        t.track(Picture().add_gate({middle_u, 90.0F}, side, roll_deg).add_noise(4.0, 1).sample());
    ASSERT_TRUE(roi) << i;
    EXPECT_NEAR(roi->center.u_px, middle_u, 1.5) << i;
    EXPECT_NEAR(roi->center.v_px, 90.0, 1.5) << i;
    EXPECT_NEAR(roi->width_px, extent_px, 4.0 + 0.05 * extent_px) << i;
    EXPECT_NEAR(roi->height_px, extent_px, 4.0 + 0.05 * extent_px) << i;
  }
}

TEST(AnchorTracker, ReportsAnchorCutByTheImageBorder) {
  AnchorTracker t = tracker();
  const auto roi = t.track(Picture().fill({300, 60, 60, 40}, kBlue).sample());
  ASSERT_TRUE(roi);
  EXPECT_TRUE(roi->cut_left_or_right);
  EXPECT_FALSE(roi->cut_above_or_below);
  EXPECT_NEAR(roi->center.u_px, 309.5, 1.0);
  EXPECT_NEAR(roi->edge_height_px, 40, 0.7);
}

TEST(AnchorTracker, CentreStaysWithinHalfAPixelUnderNoise) {
  for (const auto prefilter : {Prefilter::kNone, Prefilter::kGaussian, Prefilter::kMedian}) {
    TrackerOptions options;
    options.prefilter = prefilter;
    AnchorTracker t = tracker(options);
    KeyedRandom random({12, 0, 0});
    for (std::uint64_t i = 0; i < 60; ++i) {
      const int u = static_cast<int>(20 + 240 * random.uniform());
      const int v = static_cast<int>(10 + 150 * random.uniform());
      const int side = 2 * static_cast<int>(8 + 15 * random.uniform()) + 1;
      const auto roi =
          t.track(Picture().fill({u, v, side, side}, kBlue).add_noise(6.0, i).sample());
      ASSERT_TRUE(roi) << i;
      EXPECT_NEAR(roi->center.u_px, u + 0.5 * (side - 1), 0.5);
      EXPECT_NEAR(roi->center.v_px, v + 0.5 * (side - 1), 0.5);
      EXPECT_NEAR(roi->edge_height_px, side, 0.05 * side);
    }
  }
}

TEST(AnchorTracker, AcceptsImagesOfAnySizeAndIgnoresIncompleteOnes) {
  AnchorTracker t = tracker();
  uav::CameraSample truncated = Picture().sample();
  truncated.rgb.pop_back();
  EXPECT_FALSE(t.track(truncated));
  EXPECT_FALSE(t.track(uav::CameraSample{}));
  EXPECT_FALSE(t.track(Picture(1, 1).sample()));
  EXPECT_TRUE(t.track(Picture(640, 480).fill({600, 300, 31, 31}, kBlue).sample()));
  EXPECT_TRUE(t.track(Picture(320, 240).fill({20, 30, 31, 31}, kBlue).sample()));
}

TEST(AnchorTracker, RefusesUnusableAnchorsAndOptions) {
  uav::Anchor grey = kTracked, flat = kTracked;
  grey.color_rgb = {0.5, 0.5, 0.52};
  flat.size_m.z = 0;
  TrackerOptions even, wide, share;
  even.prefilter_size_px = 4;
  wide.hue_tolerance_deg = std::nan("");
  share.min_value = 1.5;
  for (const auto& tracker :
       {AnchorTracker::create(grey), AnchorTracker::create(flat),
        AnchorTracker::create(kTracked, even), AnchorTracker::create(kTracked, wide),
        AnchorTracker::create(kTracked, share)}) {
    ASSERT_FALSE(tracker);
    EXPECT_EQ(tracker.failure().kind, Failure::Kind::kInvalid);
  }
}

}  // namespace
}  // namespace tether::vision
