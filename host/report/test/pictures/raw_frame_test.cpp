#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/record/png.h>
#include <tether/report/camera_frame.h>

namespace tether::report {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

record::RawImage image(decltype(record::RawImage::pixels) pixels) {
  return {"uav1", "eye", from_ns<SimTime>(1'500'000'000), 4, 4, 1, std::move(pixels)};
}

std::string embedded(std::vector<std::uint8_t> rgb) {
  return record::to_data_uri(record::encode_png(4, 1, rgb));
}

TEST(RawFrame, ShowsDepthsFromTheNearestToTheFarthestAndWhatHasNone) {
  const auto depths = image(std::vector<float>{3.0F, 0.5F, kInfinity, -kInfinity});
  const std::string svg = raw_frame_svg({}, depths);
  EXPECT_THAT(svg, HasSubstr(embedded({25, 15, 80, 255, 245, 160, 0, 0, 0, 200, 30, 60})));
  for (const char* text : {"uav1 / eye, depths, ST 1.500 s", "nearest depth: 0.50 m",
                           "farthest depth: 3.00 m", "nothing: 25 %", "too near: 25 %"})
    EXPECT_THAT(svg, HasSubstr(text));
}

TEST(RawFrame, OfDepthsWithoutAMeasurementSaysSo) {
  const auto nothing = image(std::vector<float>(4, std::numeric_limits<float>::quiet_NaN()));
  const std::string svg = raw_frame_svg({}, nothing, ImageQuality::kSmall);
  EXPECT_THAT(svg, HasSubstr("nothing: 100 %"));
  EXPECT_THAT(svg, Not(HasSubstr("nearest")));
  EXPECT_THAT(svg, HasSubstr("data:image/jpeg"));
}

TEST(RawFrame, NamesTheModelsOfLabelsFromTheLargestOn) {
  record::Record record;
  record::SensorInfo& sensor = record.header.sensors.emplace_back();
  sensor.uav = "uav1";
  sensor.name = "eye";
  sensor.camera = record::CameraInfo{};
  sensor.camera->models = {"floor", "<box>"};
  const auto labels = image(std::vector<std::uint16_t>{0, 2, 2, 7});
  const std::string svg = raw_frame_svg(record, labels);
  const auto box = svg.find("&lt;box&gt;: 50 %"), other = svg.find("label 7: 25 %");
  EXPECT_LT(box, other);
  EXPECT_NE(other, std::string::npos);
  EXPECT_THAT(svg, Not(HasSubstr("floor")));
}

}  // namespace
}  // namespace tether::report
