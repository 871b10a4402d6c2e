#include "region.h"

#include <gmock/gmock.h>
#include <opencv2/imgproc.hpp>

namespace tether::vision {
namespace {

const uav::Anchor kBlueCube{"cube", uav::AnchorShape::kBox, {0.4, 0.4, 0.4}, {0.1, 0.2, 0.9}};

cv::Mat empty_map() {
  return cv::Mat(240, 320, CV_8U, cv::Scalar(0));
}

TEST(FitRectangle, GrowsOrShrinksToTheMass) {
  cv::Mat map = empty_map();
  const cv::Rect truth(100, 80, 40, 30);
  cv::rectangle(map, truth, cv::Scalar(255), cv::FILLED);
  for (const cv::Rect& start :
       {cv::Rect(90, 70, 60, 50), cv::Rect(110, 85, 20, 20), cv::Rect(105, 84, 40, 30)}) {
    EXPECT_EQ(fit_rectangle(map, start), truth);
  }
  cv::rectangle(map, cv::Rect(144, 90, 2, 2), cv::Scalar(255), cv::FILLED);
  EXPECT_EQ(fit_rectangle(map, cv::Rect(98, 78, 45, 34)), truth) << "without specks around it";
  EXPECT_EQ(fit_rectangle(empty_map(), cv::Rect(10, 10, 20, 20)), std::nullopt);
  EXPECT_EQ(fit_rectangle(empty_map(), cv::Rect(-90, 10, 20, 20)), std::nullopt);
}

TEST(Measure, CentreIsThatOfThePixels) {
  cv::Mat map = empty_map();
  cv::rectangle(map, cv::Rect(100, 80, 41, 31), cv::Scalar(255), cv::FILLED);
  const Roi roi = measure(map, cv::Rect(100, 80, 41, 31), proportions_of(kBlueCube));
  EXPECT_DOUBLE_EQ(roi.center.u_px, 120);
  EXPECT_DOUBLE_EQ(roi.center.v_px, 95);
  EXPECT_NEAR(roi.score, 1.0, 1e-9);
  EXPECT_FALSE(roi.cut_left_or_right || roi.cut_above_or_below);
}

TEST(Measure, ScoreFallsWithShapeFillAndColor) {
  const Proportions cube = proportions_of(kBlueCube);
  const auto score = [&cube](const cv::Rect& r, double value) {
    cv::Mat map = empty_map();
    cv::rectangle(map, r, cv::Scalar(value), cv::FILLED);
    return measure(map, r, cube).score;
  };
  EXPECT_LT(score({50, 50, 120, 12}, 255), 0.2) << "a strip";
  EXPECT_LT(score({50, 50, 40, 40}, 100), 0.4) << "another hue";

  cv::Mat sparse = empty_map();
  for (int i = 0; i < 40; i += 4) cv::line(sparse, {50 + i, 50}, {50 + i, 89}, cv::Scalar(255));
  EXPECT_LT(measure(sparse, {50, 50, 40, 40}, cube).score, 0.4) << "a grid";
}

TEST(Measure, WhatIsCutOffMayBeNarrow) {
  cv::Mat map = empty_map();
  const cv::Rect sliver(0, 80, 8, 40);
  cv::rectangle(map, sliver, cv::Scalar(255), cv::FILLED);
  const Roi roi = measure(map, sliver, proportions_of(kBlueCube));
  EXPECT_TRUE(roi.cut_left_or_right);
  EXPECT_GT(roi.score, 0.9);
}

TEST(FindBlobs, LargestFirstWithoutNoise) {
  cv::Mat map = empty_map();
  cv::rectangle(map, cv::Rect(20, 20, 10, 10), cv::Scalar(255), cv::FILLED);
  cv::rectangle(map, cv::Rect(100, 80, 40, 30), cv::Scalar(255), cv::FILLED);
  map.at<std::uint8_t>(200, 200) = 255;
  EXPECT_THAT(find_blobs(map, 30, 8),
              testing::ElementsAre(cv::Rect(100, 80, 40, 30), cv::Rect(20, 20, 10, 10)));
  EXPECT_EQ(find_blobs(map, 30, 1).size(), 1u);
  EXPECT_EQ(find_blobs(map, 200, 8).size(), 1u);
}

TEST(FindEdges, AreExactToAFractionOfAPixel) {
  const ColorModel color(kBlueCube.color_rgb, {});
  const cv::Scalar blue(25, 51, 230), grey(140, 140, 140);
  for (const double part : {0.0, 0.25, 0.5, 0.75}) {
    // Blue on grey; its lower and right edges cover part of a row and a column.
    cv::Mat rgb(240, 320, CV_8UC3, grey);
    const cv::Scalar mixed = part * blue + (1 - part) * grey;
    cv::rectangle(rgb, cv::Rect(100, 80, 31, 21), mixed, cv::FILLED);
    cv::rectangle(rgb, cv::Rect(100, 80, 30, 20), blue, cv::FILLED);
    cv::Mat smooth, hsv;
    cv::GaussianBlur(rgb, smooth, {5, 5}, 0);
    cv::cvtColor(smooth, hsv, cv::COLOR_RGB2HSV);
    const Edges edges = find_edges(hsv, {99, 79, 32, 22}, color);
    EXPECT_NEAR(edges.height_px, 20.0 + part, 0.3);
    EXPECT_NEAR(edges.left_px, 99.5, 0.25);
    EXPECT_NEAR(edges.right_px, 129.5 + part, 0.25);
  }
}

TEST(FindEdges, WhatIsCutOffEndsWithTheImage) {
  const ColorModel color(kBlueCube.color_rgb, {});
  cv::Mat hsv(240, 320, CV_8UC3, cv::Scalar(0, 0, 140));
  cv::rectangle(hsv, cv::Rect(0, 80, 20, 30), cv::Scalar(117, 230, 230), cv::FILLED);
  EXPECT_EQ(find_edges(hsv, {0, 80, 20, 30}, color).left_px, -0.5);
  cv::rectangle(hsv, cv::Rect(300, 80, 20, 30), cv::Scalar(117, 230, 230), cv::FILLED);
  EXPECT_EQ(find_edges(hsv, {300, 80, 20, 30}, color).right_px, 319.5);
}

TEST(Proportions, OfEachShape) {
  const Proportions cube = proportions_of(kBlueCube);
  EXPECT_LT(cube.min_width_per_height, 1.0);
  EXPECT_GT(cube.max_width_per_height, 1.42);
  const uav::Anchor pole{"pole", uav::AnchorShape::kCylinder, {0.1, 0.1, 1.0}, {1, 0, 0}};
  EXPECT_LT(proportions_of(pole).max_width_per_height, 0.2);
  const uav::Anchor ball{"ball", uav::AnchorShape::kSphere, {0.3, 0.3, 0.3}, {1, 0, 0}};
  EXPECT_GT(proportions_of(ball).max_width_per_height, 1.0);
}

}  // namespace
}  // namespace tether::vision
