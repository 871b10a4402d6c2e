#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/record/png.h>
#include <tether/report/camera_frame.h>

namespace tether::report {
namespace {

using testing::HasSubstr;
using testing::Not;

record::Image image() {
  const std::vector<std::uint8_t> rgb(12 * 8 * 3, 77);
  return {.uav = "uav1",
          .sensor = "camera",
          .at = from_ns<SimTime>(1'500'000'000),
          .index = 4,
          .png = record::encode_png(12, 8, rgb)};
}

record::Record record_with(std::vector<record::Annotation> notes) {
  record::Record record;
  for (auto& note : notes) record.annotations.push_back({SimTime{}, 0, std::move(note)});
  return record;
}

std::string roi_json(int index) {
  return R"({"u_px":5,"v_px":3,"width_px":4,"height_px":2,"image_index":)" + std::to_string(index) +
         "}";
}

TEST(CameraFrame, FindsTheRoiOfItsImage) {
  const auto record = record_with({{"uav1", {}, "roi", roi_json(3)},
                                   {"uav2", {}, "roi", roi_json(4)},
                                   {"uav1", {}, "estimate", roi_json(4)},
                                   {"uav1", {}, "roi", "no json"},
                                   {"uav1", {}, "roi", R"({"image_index":4,"u_px":"5"})"},
                                   {"uav1", {}, "roi", roi_json(4)}});
  const auto roi = find_roi(record, image());
  ASSERT_TRUE(roi);
  EXPECT_EQ(roi->u_px, 5.0);
  EXPECT_EQ(roi->height_px, 2.0);
  EXPECT_FALSE(find_roi(record_with({{"uav1", {}, "roi", roi_json(3)}}), image()));
}

TEST(CameraFrame, FramesTheRoiInTheImage) {
  const std::string svg = frame_svg(image(), ReportedRoi{5.0, 3.0, 4.0, 2.0});
  EXPECT_THAT(svg, HasSubstr(R"(<image width="12" height="8" href="data:image/png;base64,iVBOR)"));
  EXPECT_THAT(svg, HasSubstr(R"(<rect x="3.50" y="2.50" width="4.00" height="2.00")"));
  EXPECT_THAT(svg, HasSubstr("ST 1.500 s"));
}

TEST(CameraFrame, SaysWhereNothingWasFound) {
  const std::string svg = frame_svg(image(), std::nullopt);
  EXPECT_THAT(svg, HasSubstr("anchor not found"));
  EXPECT_THAT(svg, Not(HasSubstr("stroke=")));
}

}  // namespace
}  // namespace tether::report
