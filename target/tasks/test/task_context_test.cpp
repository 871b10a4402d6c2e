#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <tether/tasks/task.h>
#include <tether/tasks/testing/planar_vehicle.h>

namespace tether::tasks {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

TEST(TaskContext, FindsWhatTheCatalogueHas) {
  testing::PlanarVehicle vehicle({});
  TaskContext context(vehicle);
  ASSERT_TRUE(context.camera());
  EXPECT_EQ((*context.camera())->name, "camera");
  ASSERT_TRUE(context.anchor("blue_box"));
  EXPECT_EQ((*context.anchor("blue_box"))->size_m.z, 0.5);
  ASSERT_TRUE(context.sensor("imu", uav::SensorKind::kImu));
  EXPECT_EQ((*context.sensor("imu", uav::SensorKind::kImu))->name, "imu");
  const auto first = context.tracker("blue_box");
  const auto again = context.tracker("blue_box");
  ASSERT_TRUE(first && again);
  EXPECT_EQ(*first, *again) << "one tracker for each anchor";
}

TEST(TaskContext, NamesWhatTheCatalogueLacks) {
  testing::PlanarVehicle vehicle({});
  TaskContext context(vehicle);
  const auto expect_missing = [](const auto& found, const std::string& name) {
    ASSERT_FALSE(found);
    EXPECT_EQ(found.failure().kind, Failure::Kind::kInvalid);
    EXPECT_THAT(found.failure().message, HasSubstr("\"" + name + "\""));
  };
  expect_missing(TaskContext(vehicle, {"eye", {}}).camera(), "eye");
  expect_missing(TaskContext(vehicle, {"imu", {}}).camera(), "imu");
  expect_missing(context.sensor("gps", uav::SensorKind::kImu), "gps");
  expect_missing(context.anchor("door"), "door");
  EXPECT_THAT(context.anchor("door").failure().message, HasSubstr("'blue_box'"));
  EXPECT_THAT(TaskContext(vehicle, {"imu", {}}).camera().failure().message,
              ::testing::Not(HasSubstr("'imu'")));
  expect_missing(context.tracker("door"), "door");
  expect_missing(context.tracker("grey_box"), "grey_box");
  VisionOptions unusable{"eye", {}};
  unusable.tracker.prefilter_size_px = 4;
  ASSERT_TRUE(context.tracker("blue_box"));
  context.look_with(unusable);
  expect_missing(context.camera(), "eye");
  EXPECT_FALSE(context.tracker("blue_box")) << "the old options were kept";
}

TEST(TaskContext, NotesHaveTheFieldsOfTheRecord) {
  testing::PlanarVehicle vehicle({});
  TaskContext context(vehicle);
  vision::Roi roi;
  roi.center = {12.5, 7};
  roi.width_px = 20;
  context.note_roi(roi, 42);
  context.note_estimate("blue_box", 42, {0.25, std::nullopt}, true);
  context.note_event("face_anchor", "loop", "reverse", {{"yaw_rate_rad_s", -0.2}});

  const auto& notes = vehicle.annotations();
  context.note_odometry({1, -2, 0}, 0.5);
  context.note_displacement({0.25, 0.5, 0});
  ASSERT_EQ(notes.size(), 5u);
  EXPECT_EQ(notes[0].topic, "roi");
  const json noted_roi = json::parse(notes[0].json);
  EXPECT_EQ(noted_roi.at("camera"), "camera");
  EXPECT_EQ(noted_roi.at("u_px"), 12.5);
  EXPECT_EQ(noted_roi.at("image_index"), 42);
  for (const char* field : {"v_px", "width_px", "height_px", "angle_rad", "score"}) {
    EXPECT_TRUE(noted_roi.contains(field)) << field;
  }
  EXPECT_EQ(notes[1].topic, "estimate");
  EXPECT_EQ(json::parse(notes[1].json), json({{"anchor", "blue_box"},
                                              {"camera", "camera"},
                                              {"image_index", 42},
                                              {"bearing_rad", 0.25},
                                              {"distance_m", nullptr},
                                              {"converged", true}}));
  EXPECT_EQ(notes[2].topic, "task");
  EXPECT_EQ(json::parse(notes[2].json).at("yaw_rate_rad_s"), -0.2);
  EXPECT_EQ(notes[3].topic, "odometry");
  EXPECT_EQ(json::parse(notes[3].json), json({{"x_m", 1.0}, {"y_m", -2.0}, {"yaw_rad", 0.5}}));
  EXPECT_EQ(notes[4].topic, "displacement");
  EXPECT_EQ(json::parse(notes[4].json), json({{"x_m", 0.25}, {"y_m", 0.5}}));
}

}  // namespace
}  // namespace tether::tasks
