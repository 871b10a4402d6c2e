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
  const auto found = [](const char* uav, const char* topic, const std::string& json) {
    return find_roi(record_with({{uav, {}, topic, json}}), image());
  };
  const auto roi = found("uav1", "roi", roi_json(4));
  ASSERT_TRUE(roi);
  EXPECT_EQ(roi->u_px, 5.0);
  EXPECT_EQ(roi->height_px, 2.0);
  EXPECT_FALSE(found("uav1", "roi", roi_json(3)));
  EXPECT_FALSE(found("uav2", "roi", roi_json(4)));
  EXPECT_FALSE(found("uav1", "estimate", roi_json(4)));
  EXPECT_FALSE(found("uav1", "roi", "no json"));
  EXPECT_FALSE(found("uav1", "roi", R"({"image_index":4,"u_px":"5"})"));
  EXPECT_FALSE(found("uav1", "roi", R"({"camera":"rear",)" + roi_json(4).substr(1)));
}

// A UAV at the origin of W whose camera looks east, with a box of 0.4 m straight ahead, its near
// side at 2 m: at 10 px of focal length, 2 px wide.
record::Record record_with_truth() {
  record::Record record;
  record::SensorInfo& sensor = record.header.sensors.emplace_back();
  sensor.uav = "uav1";
  sensor.name = "camera";
  sensor.camera = record::CameraInfo{{}, {1, 0, 0, 0}, 12, 8, 10.0, 10.0, 5.5, 3.5};
  record.header.anchors = {{"box", "box", {0.4, 0.4, 0.4}, {2.2, 0, 0}, {1, 0, 0, 0}},
                           {"aside", "box", {0.4, 0.4, 0.4}, {2.2, 0.6, 0}, {1, 0, 0, 0}}};
  record::GroundTruth truth;
  truth.uav = "uav1";
  truth.at = image().at;
  record.ground_truth = {{truth.at, 0, truth}};
  return record;
}

void add_estimate(record::Record& record, const std::string& anchor, int image_index) {
  record.annotations.push_back(
      {SimTime{},
       0,
       {"uav1",
        {},
        "estimate",
        R"({"anchor":")" + anchor + R"(","image_index":)" + std::to_string(image_index) + "}"}});
}

TEST(CameraFrame, FindsTheTrueRoiOfTheTargetAnchor) {
  record::Record record = record_with_truth();
  EXPECT_FALSE(find_true_roi(record, image()));  // two anchors, and no estimate
  add_estimate(record, "box", 4);
  const auto roi = find_true_roi(record, image());
  ASSERT_TRUE(roi);
  EXPECT_FALSE(roi->is_of_pixels);
  EXPECT_NEAR(roi->rect->left_px, 4.5, 1e-9);
  EXPECT_NEAR(roi->rect->right_px, 6.5, 1e-9);
  EXPECT_NEAR(roi->rect->top_px, 2.5, 1e-9);

  add_estimate(record, "aside", 5);  // of a later image
  EXPECT_NEAR(find_true_roi(record, image())->rect->left_px, 4.5, 1e-9);
  add_estimate(record, "aside", 4);
  EXPECT_NEAR(find_true_roi(record, image())->rect->left_px, 1.5, 1e-9);
}

// What of an anchor is seen decides, if the record knows it.
TEST(CameraFrame, FindsTheTrueRoiOfVisiblePixels) {
  record::Record record = record_with_truth();
  add_estimate(record, "box", 4);
  record::Interaction read;
  read.uav = "uav1";
  read.kind = record::kSensor;
  read.sensor = "camera";
  read.sample_index = 4;
  read.sampled_at = image().at;
  read.seen_anchors = {{"box", 6, 3, 6, 4, 2}};
  record.interactions = {{image().at, 0, read}};
  const auto roi = find_true_roi(record, image());
  ASSERT_TRUE(roi && roi->rect);
  EXPECT_TRUE(roi->is_of_pixels);
  EXPECT_NEAR(roi->rect->left_px, 5.5, 1e-9);  // hidden left of it
  EXPECT_NEAR(roi->rect->right_px, 6.5, 1e-9);
  record.interactions[0].message.seen_anchors->clear();
  EXPECT_FALSE(find_true_roi(record, image())->rect);
  EXPECT_THAT(frame_svg(image(), {}, find_true_roi(record, image())), HasSubstr("not visible"));
}

TEST(CameraFrame, TakesTheOnlyAnchorWithoutAnEstimate) {
  record::Record record = record_with_truth();
  record.header.anchors.pop_back();
  EXPECT_TRUE(find_true_roi(record, image()));
  record.header.sensors[0].camera.reset();
  EXPECT_FALSE(find_true_roi(record, image()));
}

TEST(CameraFrame, FramesBothRoisWithACaption) {
  const std::string svg = frame_svg(image(), ReportedRoi{5.0, 3.0, 4.0, 2.0},
                                    TrueRoi{campaign::PixelRect{1.0, 2.0, 4.0, 7.0}});
  for (const char* part : {R"(<image width="12" height="8" href="data:image/png;base64,iVBOR)",
                           R"(<rect x="3.50" y="2.50" width="4.00" height="2.00")",
                           R"(<rect x="1.50" y="2.50" width="3.00" height="5.00")",
                           ">uav1 / camera, ST 1.500 s<", ">ROI tracked by the SUT, 4 x 2 px<",
                           ">true ROI (projection of the whole anchor), 3 x 5 px<"})
    EXPECT_THAT(svg, HasSubstr(part));
  const std::string without = frame_svg(image(), std::nullopt, std::nullopt);
  EXPECT_THAT(without, HasSubstr(">no ROI reported by the SUT<"));
  EXPECT_THAT(without, Not(HasSubstr("true ROI")));
  EXPECT_THAT(without, Not(HasSubstr(R"(fill="none")")));
}

}  // namespace
}  // namespace tether::report
