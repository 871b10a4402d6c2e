#include <gmock/gmock.h>

#include <tether/tasks/paper_tasks.h>
#include <tether/tasks/task.h>
#include <tether/tasks/testing/planar_vehicle.h>

namespace tether::tasks {
namespace {

using std::chrono::milliseconds;

/// The fake's images are a quarter as wide as those that the default is for.
const RelativePositionOptions kOptions{.convergence = {.tolerance_px = 2.0}};

struct Approach {
  explicit Approach(const testing::PlanarVehicle::Options& options = {}) : vehicle(options) {}
  TaskOutcome run_task(const std::string& anchor = "blue_box") {
    task = std::make_unique<RelativePositionTask>(anchor, kOptions);
    return run(*task, context);
  }
  int count(std::string_view topic) const {
    int n = 0;
    for (const auto& annotation : vehicle.annotations()) n += annotation.topic == topic ? 1 : 0;
    return n;
  }
  testing::PlanarVehicle vehicle;
  TaskContext context{vehicle};
  std::unique_ptr<RelativePositionTask> task;
};

TEST(RelativePositionTask, MeasuresBearingAndDistance) {
  Approach f({.anchor_bearing_rad = rad_from_deg(20), .anchor_distance_m = 3});
  const TaskOutcome outcome = f.run_task();
  EXPECT_TRUE(outcome.reached()) << outcome.reason;
  EXPECT_NEAR(deg_from_rad(outcome.results.at("bearing_rad")), 20, 0.4);
  EXPECT_NEAR(outcome.results.at("distance_m"), 3, 0.2);
  EXPECT_EQ(outcome.results.at("frames"), 3);
  ASSERT_TRUE(f.task->estimate());
  EXPECT_EQ(f.task->estimate()->bearing_rad, outcome.results.at("bearing_rad"));
  EXPECT_TRUE(f.vehicle.commands().empty());
  EXPECT_EQ(f.count("roi"), 3);
  EXPECT_EQ(f.count("estimate"), 3);
  EXPECT_EQ(run(*f.task, f.context).results.at("bearing_rad"), outcome.results.at("bearing_rad"));
}

TEST(RelativePositionTask, KeepsWhatItsLastEstimateWasMadeFrom) {
  // The anchor is gone after the second image, so that later ones bring no estimate.
  Approach f({.anchor_hidden = {milliseconds(60), std::chrono::hours(1)}});
  EXPECT_FALSE(f.run_task().reached());
  EXPECT_GT(f.vehicle.images_read(), 2);
  ASSERT_TRUE(f.task->sighting());
  const auto& [image, roi] = *f.task->sighting();
  EXPECT_EQ(image.index, 1u);
  EXPECT_EQ(image.rgb.size(), 160u * 120u * 3u);
  EXPECT_TRUE(f.task->estimate());
  EXPECT_GT(roi.width_px, 5.0);
  const auto& camera = f.vehicle.catalogue().sensors.front();
  const auto again =
      vision::relative_position(camera, *f.vehicle.catalogue().find_anchor("blue_box"), roi);
  EXPECT_EQ(again.bearing_rad, f.task->estimate()->bearing_rad);
}

TEST(RelativePositionTask, ConvergesWhileTurning) {
  for (const auto compute : {milliseconds(2), milliseconds(150)}) {
    Approach f({.anchor_bearing_rad = rad_from_deg(25), .compute_per_image = compute});
    ASSERT_TRUE(f.vehicle.command_velocity({{}, rad_from_deg(15)}));
    ASSERT_TRUE(f.vehicle.sleep_for(milliseconds(300)));
    const TaskOutcome outcome = f.run_task();
    EXPECT_TRUE(outcome.reached()) << outcome.reason;
    EXPECT_EQ(outcome.results.at("frames"), compute < milliseconds(50) ? 3 : 4);
  }
}

TEST(RelativePositionTask, EndsWithTheReasonWhyItDidNotReachItsGoal) {
  RelativePositionOptions impossible = kOptions, hurried = kOptions;
  impossible.convergence.tolerance_px = -1;
  hurried.time_limit = milliseconds(500);
  struct Case {
    testing::PlanarVehicle::Options world;
    RelativePositionOptions options;
    std::string reason;
    int images;
    bool has_estimate;
  };
  const int unseen = kOptions.convergence.max_unseen_frames;
  for (const Case& c : std::vector<Case>{
           {{.anchor_is_there = false}, kOptions, "anchor not seen", unseen, false},
           {{.anchor_is_there = false, .clock_stands_still = true},
            kOptions,
            "anchor not seen",
            unseen,
            false},
           {{}, impossible, "did not converge", impossible.convergence.max_frames, true},
           {{.compute_per_image = milliseconds(400)}, hurried, "time limit", 2, true}}) {
    Approach f(c.world);
    RelativePositionTask task("blue_box", c.options);
    const TaskOutcome outcome = run(task, f.context);
    EXPECT_EQ(outcome.status, TaskStatus::kNotReached);
    EXPECT_EQ(outcome.reason, c.reason);
    EXPECT_EQ(f.vehicle.images_read(), c.images);
    EXPECT_EQ(task.estimate().has_value(), c.has_estimate);
    EXPECT_EQ(task.sighting().has_value(), c.has_estimate);
  }
}

TEST(RelativePositionTask, AShortLossCostsImagesOnly) {
  Approach f({.anchor_hidden = {milliseconds(60), milliseconds(130)}});
  const TaskOutcome outcome = f.run_task();
  EXPECT_TRUE(outcome.reached()) << outcome.reason;
  EXPECT_GT(outcome.results.at("frames"), 3);
}

TEST(RelativePositionTask, FailsWithItsReason) {
  EXPECT_EQ(Approach().run_task("door").failure, Failure::Kind::kInvalid);
  EXPECT_EQ(Approach().run_task("grey_box").failure, Failure::Kind::kInvalid);
  Approach cut({.disconnect_at = 1});
  const TaskOutcome outcome = cut.run_task();
  EXPECT_EQ(outcome.status, TaskStatus::kFailed);
  EXPECT_EQ(outcome.failure, Failure::Kind::kDisconnected);
}

}  // namespace
}  // namespace tether::tasks
