#include "layered_sensor.h"

#include "sensor_world.h"
#include "test_files.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/sim/bodies.h>

namespace tether::scenario {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;

/// The entry [sensors.<name>] of a profile.
SensorProfile entry(const ScratchFolder& scratch, const std::string& name,
                    const std::string& text) {
  return load_profile(scratch.write(name + ".toml", text)).sensors.at(name);
}

class Layered : public testing::Test {
 protected:
  SensorProfile full(const std::string& name) const { return entry(scratch_, name, kFullProfile); }
  /// An entry of that kind with a few lines; line 3 says the kind.
  SensorProfile layer(const std::string& kind, const std::string& lines) const {
    return entry(scratch_, kind,
                 "name = \"x\"\n[sensors." + kind + "]\nkind = \"" + kind + "\"\n" + lines);
  }
  uav::SensorTiming lay(sim::Sensor& sensor, const std::vector<SensorProfile>& layers) const {
    LayeredSensor layered(sensor);
    for (const SensorProfile& one : layers) layered.lay(one);
    return layered.finish();
  }
  const uav::CameraModel& lens() const {
    return std::get<sim::CameraModel>(camera_.model).intrinsics;
  }

  ScratchFolder scratch_;
  sim::Sensor camera_ = make_camera("camera");
  sim::Sensor imu_ = make_imu("imu");
  sim::Sensor range_ = make_range("range");
};

// Every key arrives.

TEST_F(Layered, EveryKeyOfACameraArrives) {
  const auto timing = std::get<uav::PeriodicTiming>(lay(camera_, {full("camera")}));
  EXPECT_EQ(timing.period, milliseconds(40));
  EXPECT_EQ(timing.phase, milliseconds(4));
  EXPECT_THAT(std::get<uav::EmpiricalDelay>(timing.delay).samples,
              ElementsAre(Duration(33'100'000), Duration(33'400'000)));
  EXPECT_EQ(camera_.X_BS.p, (uav::Vec3{0.1, 0.2, -0.05}));
  EXPECT_EQ(camera_.X_BS.q, uav::from_rpy(0.0, rad_from_deg(90), 0.0));
  EXPECT_EQ(camera_.update_rate_hz, 25.0);
  EXPECT_EQ(lens().width_px, 320);
  EXPECT_EQ(lens().height_px, 200);
  EXPECT_NEAR(lens().fx_px, 160.0, 1e-9);
  EXPECT_THAT((std::vector{lens().fy_px, lens().cx_px, lens().cy_px}),
              ElementsAre(lens().fx_px, 159.5, 99.5));
  EXPECT_THAT((std::vector{lens().k1, lens().k2, lens().k3, lens().p1, lens().p2}),
              ElementsAre(-0.25, 0.06, 0.01, 0.002, -0.001));
  const auto& model = std::get<sim::CameraModel>(camera_.model);
  EXPECT_THAT(values_of(model.pixel_noise), ElementsAre(0.01, 0.02, 0.03, 0.04, 0.05, 60.0));
  EXPECT_DOUBLE_EQ(model.exposure_s, 0.008);
  EXPECT_DOUBLE_EQ(model.readout_s, 0.0125);
  EXPECT_TRUE(model.antialias);
  EXPECT_EQ(model.antialias_at.line, 16);
}

TEST_F(Layered, EveryKeyOfAnImuArrivesOnAllAxes) {
  const auto timing = std::get<uav::PeriodicTiming>(lay(imu_, {full("imu")}));
  EXPECT_EQ(timing.period, milliseconds(50));
  EXPECT_EQ(std::get<uav::NormalDelay>(timing.delay).mean, milliseconds(4));
  EXPECT_EQ(std::get<uav::NormalDelay>(timing.delay).stddev, Duration(1'500'000));
  const auto& model = std::get<sim::ImuModel>(imu_.model);
  for (const sim::Noise& axis : model.angular_velocity)
    EXPECT_THAT(values_of(axis), ElementsAre(0.0, 0.001, 0.0, 0.002, 0.0, 0.0));
  for (const sim::Noise& axis : model.linear_acceleration)
    EXPECT_THAT(values_of(axis), ElementsAre(0.0, 0.01, 0.0, 0.0, 0.0, 0.0));
}

TEST_F(Layered, EveryKeyOfARangefinderArrives) {
  const auto timing = lay(range_, {full("range")});
  EXPECT_EQ(std::get<uav::ConstantDelay>(std::get<uav::OnDemandTiming>(timing).delay).value,
            Duration(97'700'000));
  EXPECT_EQ(range_.update_rate_hz, 0.0);
  const auto& model = std::get<sim::RangeModel>(range_.model);
  EXPECT_EQ(model.min_m, 0.05);
  EXPECT_EQ(model.max_m, 3.0);
  EXPECT_EQ(model.resolution_m, 0.001);
  EXPECT_EQ(model.dropout_probability, 0.125);
  EXPECT_THAT(values_of(model.noise), ElementsAre(0.01, 0.005, 0.0, 0.0, 0.0, 0.0));
  EXPECT_EQ(model.rays_S, sim::cone_of_rays(rad_from_deg(27)));
  EXPECT_GT(model.rays_S.size(), 1u);
}

TEST_F(Layered, EveryKeyOfAReceiverArrives) {
  sim::Sensor navsat{"navsat", {}, 10.0, sim::NavSatModel{}};
  lay(navsat, {layer("navsat",
                     "horizontal_noise_m = { stddev = 1 }\n"
                     "vertical_noise_m = { stddev = 2 }\n"
                     "horizontal_velocity_noise_m_s = { stddev = 3 }\n"
                     "vertical_velocity_noise_m_s = { stddev = 4 }\n"
                     "outage_every_s = 60\noutage_lasts_s = 5\n")});
  const auto& model = std::get<sim::NavSatModel>(navsat.model);
  EXPECT_THAT((std::vector{model.horizontal_m.stddev, model.vertical_m.stddev,
                           model.horizontal_velocity_m_s.stddev, model.vertical_velocity_m_s.stddev,
                           model.outage_every_s, model.outage_lasts_s}),
              ElementsAre(1.0, 2.0, 3.0, 4.0, 60.0, 5.0));
  expect_refusal(4, "navsat", [&] { lay(navsat, {layer("navsat", "outage_lasts_s = 61\n")}); });
  sim::Sensor other{"navsat", {}, 10.0, sim::NavSatModel{}};
  expect_refusal(4, "navsat", [&] { lay(other, {layer("navsat", "outage_every_s = 60\n")}); });
}

TEST_F(Layered, EveryKeyOfAMagnetometerAndABarometerArrives) {
  sim::Sensor magnetometer{"magnetometer", {}, 10.0, sim::MagnetometerModel{}};
  lay(magnetometer, {layer("magnetometer",
                           "noise_T = { stddev = 1e-7 }\n"
                           "hard_iron_T = [1e-6, -2e-6, 0]\n")});
  const auto& model = std::get<sim::MagnetometerModel>(magnetometer.model);
  for (const sim::Noise& axis : model.field_T) EXPECT_EQ(axis.stddev, 1e-7);
  EXPECT_EQ(model.hard_iron_T, (uav::Vec3{1e-6, -2e-6, 0.0}));
  sim::Sensor barometer{"barometer", {}, 10.0, sim::BarometerModel{}};
  lay(barometer, {layer("barometer", "noise_Pa = { stddev = 3 }\n")});
  EXPECT_EQ(std::get<sim::BarometerModel>(barometer.model).pressure_Pa.stddev, 3.0);
}

TEST_F(Layered, EveryKeyOfAnOdometryArrives) {
  sim::Sensor odometry{"odometry", {}, 10.0, sim::OdometryModel{}};
  lay(odometry, {layer("odometry",
                       "position_noise_m = { stddev = 1 }\n"
                       "velocity_noise_m_s = { stddev = 2 }\n"
                       "tilt_noise_rad = { stddev = 3 }\n"
                       "yaw_noise_rad = { stddev = 4 }\n"
                       "angular_velocity_noise_rad_s = { stddev = 5 }\n")});
  const auto& model = std::get<sim::OdometryModel>(odometry.model);
  EXPECT_THAT(
      (std::vector{model.position_m.stddev, model.velocity_m_s.stddev, model.tilt_rad.stddev,
                   model.yaw_rad.stddev, model.angular_velocity_rad_s.stddev}),
      ElementsAre(1.0, 2.0, 3.0, 4.0, 5.0));
}

TEST_F(Layered, EveryKeyOfAJointStateArrives) {
  sim::Sensor joints{"joint_state", {}, 0.0, sim::JointStateModel{}};
  lay(joints, {layer("joint_state", "angle_noise_rad = { stddev = 0.1 }\n")});
  EXPECT_EQ(std::get<sim::JointStateModel>(joints.model).angle_rad.stddev, 0.1);
}

TEST_F(Layered, EveryKeyOfALidarArrives) {
  sim::Sensor lidar{"lidar", {}, 10.0, sim::ScanModel{}};
  lay(lidar, {layer("scan",
                    "rays = [1080, 16]\nsweep_ms = 100\nmin_m = 0.5\nmax_m = 30\n"
                    "resolution_m = 0.01\ndropout_probability = 0.25\n"
                    "noise_m = { stddev = 0.02 }\n")});
  const auto& model = std::get<sim::ScanModel>(lidar.model);
  EXPECT_EQ(model.rays.columns, 1080);
  EXPECT_EQ(model.rays.rows, 16);
  EXPECT_THAT((std::vector{model.rays.sweep_s, model.rays.min_m, model.rays.max_m,
                           model.resolution_m, model.dropout_probability, model.noise.stddev}),
              ElementsAre(0.1, 0.5, 30.0, 0.01, 0.25, 0.02));
  expect_refusal(4, "lidar", [&] { lay(lidar, {layer("scan", "sweep_ms = 101\n")}); });
  expect_refusal(4, "rays", [&] { lay(lidar, {layer("scan", "rays = [2049, 128]\n")}); });
  expect_refusal(4, "rays", [&] { lay(lidar, {layer("scan", "rays = [9]\n")}); });
}

// Of a sensor of any kind, and each key replaces its own value only.
TEST_F(Layered, EveryKeyOfADriverArrivesAndNeedsATimingThatFits) {
  sim::Sensor barometer{"barometer", {}, 10.0, sim::BarometerModel{}};
  lay(barometer, {layer("barometer",
                        "stamp_offset_ms = -12.5\nstamp_jitter_ms = 50\n"
                        "stamp_drift_ppm = -40.5\nlost_probability = 0.1\n"),
                  layer("barometer", "stamp_drift_ppm = 3\nrepeated_probability = 0.2\n")});
  EXPECT_EQ(barometer.driver,
            (uav::DriverModel{Duration(-12'500'000), milliseconds(50), 3'000, 0.1, 0.2}));

  const auto lay_on_imu = [&](const std::string& lines) {
    sim::Sensor imu = make_imu("imu");
    lay(imu, {layer("imu", lines)});
  };
  const std::string fast = "timing = \"periodic\"\nrate_hz = 200\n";
  const std::string on_demand = "timing = \"on_demand\"\n";
  EXPECT_NO_THROW(lay_on_imu(fast + "stamp_jitter_ms = 2.5\n"));
  expect_refusal(6, "imu", [&] { lay_on_imu(fast + "stamp_jitter_ms = 2.6\n"); });
  EXPECT_NO_THROW(lay_on_imu(on_demand + "stamp_jitter_ms = 20\n"));
  expect_refusal(5, "imu", [&] { lay_on_imu(on_demand + "lost_probability = 0.1\n"); });
  expect_refusal(5, "imu", [&] { lay_on_imu(on_demand + "repeated_probability = 0.1\n"); });
  expect_refusal(4, "lost_probability", [&] { lay_on_imu("lost_probability = 1\n"); });
}

// The SDF's camera sees up to 100 m.
TEST_F(Layered, LimitsOfDepthsArriveAndTheCameraSeesAsFar) {
  for (const auto kind : {uav::CameraKind::kDepth, uav::CameraKind::kRgbd}) {
    for (const double max_m : {30.0, 300.0}) {
      sim::Sensor camera = make_camera("camera");
      auto& model = std::get<sim::CameraModel>(camera.model);
      model.kind = kind;
      lay(camera, {layer("camera", "max_m = 500\n"),
                   layer("camera", fmt::format("min_m = 0.4\nmax_m = {}\n", max_m))});
      EXPECT_THAT((std::vector{model.depth_min_m, model.depth_max_m, model.far_m}),
                  ElementsAre(0.4, max_m, std::max(100.0, max_m)));
    }
  }
}

TEST_F(Layered, RefusesWhatACameraOfThatTypeCannotHave) {
  const auto lay_on = [&](uav::CameraKind kind, const std::string& lines) {
    sim::Sensor camera = make_camera("camera");
    std::get<sim::CameraModel>(camera.model).kind = kind;
    std::get<sim::CameraModel>(camera.model).depth_max_m = 20.0;
    lay(camera, {layer("camera", "delay = { kind = \"constant\", ms = 5 }\n" + lines)});
  };
  using enum uav::CameraKind;
  expect_refusal(5, "min_m", [&] { lay_on(kColor, "min_m = 1\n"); });
  expect_refusal(5, "max_m", [&] { lay_on(kSegmentation, "max_m = 1\n"); });
  expect_refusal(5, "noise", [&] { lay_on(kSegmentation, "noise = { stddev = 1 }\n"); });
  EXPECT_NO_THROW(lay_on(kSegmentation, "noise = {}\n"));
  for (const auto kind : {kDepth, kSegmentation}) {
    expect_refusal(5, "antialias", [&] { lay_on(kind, "antialias = true\n"); });
    EXPECT_NO_THROW(lay_on(kind, "antialias = false\n"));
  }
  EXPECT_NO_THROW(lay_on(kRgbd, "antialias = true\n"));
  expect_refusal(5, "camera", [&] { lay_on(kDepth, "min_m = 20\n"); });
}

// What a layer does not set stays.

TEST_F(Layered, WithoutALayerNothingChanges) {
  const sim::Sensor before = camera_;
  EXPECT_EQ(std::get<uav::PeriodicTiming>(lay(camera_, {})).period, Duration(33'333'333));
  EXPECT_EQ(camera_.X_BS, before.X_BS);
  EXPECT_EQ(camera_.update_rate_hz, before.update_rate_hz);
  EXPECT_EQ(lens().fx_px, std::get<sim::CameraModel>(before.model).intrinsics.fx_px);
}

TEST_F(Layered, ALayerChangesOnlyWhatItSets) {
  lay(range_, {layer("range", "position_m = [0, 0, 1]\nmax_m = 2\n")});
  const auto& model = std::get<sim::RangeModel>(range_.model);
  EXPECT_EQ(range_.X_BS.p, (uav::Vec3{0.0, 0.0, 1.0}));
  EXPECT_EQ(range_.X_BS.q, uav::Quat{});
  EXPECT_EQ(range_.update_rate_hz, 30.0);
  EXPECT_EQ(model.min_m, 0.04);
  EXPECT_EQ(model.max_m, 2.0);
  EXPECT_EQ(model.resolution_m, 0.001);
  EXPECT_EQ(model.noise.stddev, 0.005);
  EXPECT_EQ(model.rays_S.size(), 1u);
  lay(camera_, {layer("camera", "rpy_deg = [0, 0, 90]\n")});
  EXPECT_EQ(camera_.X_BS.p, (uav::Vec3{0.1, 0.0, 0.0}));
  EXPECT_EQ(camera_.X_BS.q, uav::from_rpy(0.0, 0.0, rad_from_deg(90)));
}

TEST_F(Layered, TheLastLayerThatSetsItDecidesWhetherACameraIsAntialiased) {
  const auto& model = std::get<sim::CameraModel>(camera_.model);
  lay(camera_, {layer("camera", "exposure_ms = 1\n")});
  EXPECT_FALSE(model.antialias);
  EXPECT_EQ(model.antialias_at.line, 0);
  lay(camera_, {layer("camera", "antialias = true\n"), layer("camera", "readout_ms = 1\n")});
  EXPECT_TRUE(model.antialias);
  EXPECT_EQ(model.antialias_at.line, 4);
  lay(camera_, {layer("camera", "readout_ms = 1\nantialias = false\n")});
  EXPECT_FALSE(model.antialias);
  EXPECT_EQ(model.antialias_at.line, 5);
}

TEST_F(Layered, AnEmptyNoiseIsNoNoise) {
  lay(range_, {layer("range", "noise_m = {}\n")});
  EXPECT_EQ(std::get<sim::RangeModel>(range_.model).noise, sim::Noise{});
}

// Timing.

TEST_F(Layered, ATimingReplacesTheWholeTimingBelow) {
  const auto timing = std::get<uav::PeriodicTiming>(
      lay(camera_, {full("camera"), layer("camera", "timing = \"periodic\"\nrate_hz = 10\n")}));
  EXPECT_EQ(timing.period, milliseconds(100));
  EXPECT_EQ(timing.phase, Duration{0});
  EXPECT_EQ(std::get<uav::ConstantDelay>(timing.delay).value, Duration{0});
}

TEST_F(Layered, ADelayReplacesTheDelayOnly) {
  const std::string delay = "delay = { kind = \"constant\", ms = 5 }\n";
  const auto periodic =
      std::get<uav::PeriodicTiming>(lay(camera_, {full("camera"), layer("camera", delay)}));
  EXPECT_EQ(periodic.period, milliseconds(40));
  EXPECT_EQ(periodic.phase, milliseconds(4));
  EXPECT_EQ(std::get<uav::ConstantDelay>(periodic.delay).value, milliseconds(5));
  const auto of_sdf = std::get<uav::PeriodicTiming>(lay(imu_, {layer("imu", delay)}));
  EXPECT_EQ(of_sdf.period, milliseconds(50));
  EXPECT_EQ(std::get<uav::ConstantDelay>(of_sdf.delay).value, milliseconds(5));
  sim::Sensor range = make_range("range", 0.0);
  const auto on_demand = std::get<uav::OnDemandTiming>(lay(range, {layer("range", delay)}));
  EXPECT_EQ(std::get<uav::ConstantDelay>(on_demand.delay).value, milliseconds(5));
}

TEST_F(Layered, TheSensorGetsTheRateOfItsTiming) {
  lay(camera_, {layer("camera", "timing = \"periodic\"\nrate_hz = 30\n")});
  EXPECT_EQ(camera_.update_rate_hz, 30.0);
  lay(camera_, {layer("camera", "timing = \"periodic\"\nperiod_ms = 33.3\n")});
  EXPECT_NEAR(camera_.update_rate_hz, 1e3 / 33.3, 1e-9);
  lay(camera_, {layer("camera", "timing = \"periodic\"\nrate_hz = 0.001\n")});
  EXPECT_NEAR(camera_.update_rate_hz, 0.001, 1e-12);
}

// The lens.

TEST_F(Layered, ALayerReplacesFieldOfViewSizeAndDistortionEachAsAWhole) {
  const auto with = [&](const std::string& key, double cx_px) {
    sim::Sensor camera = make_camera("camera");
    auto& model = std::get<sim::CameraModel>(camera.model).intrinsics;
    model.fy_px = 700.0;
    model.cx_px = cx_px;
    model.k2 = -0.2;
    lay(camera, {layer("camera", key)});
    return model;
  };
  const auto smaller = with("size_px = [320, 240]\n", 319.5);
  const auto wider = with("horizontal_fov_deg = 90\n", 300.0);
  EXPECT_NEAR(smaller.fx_px, 160.0 / std::tan(rad_from_deg(40)), 1e-9);
  EXPECT_EQ(smaller.cx_px, 159.5);
  EXPECT_EQ(smaller.cy_px, 119.5);
  EXPECT_EQ(smaller.k2, -0.2);
  EXPECT_NEAR(wider.fx_px, 320.0, 1e-9);
  EXPECT_EQ(wider.fy_px, wider.fx_px);
  EXPECT_EQ(wider.cx_px, 319.5);
  EXPECT_EQ(wider.width_px, 640);
  const auto distorted = with("distortion = { k1 = 0.1 }\n", 319.5);
  EXPECT_EQ(distorted.k1, 0.1);
  EXPECT_EQ(distorted.k2, 0.0);
}

// Values that exclude each other.

TEST_F(Layered, RefusesKeysOfAnotherKindAtTheirLine) {
  SensorProfile wrong = layer("range", "max_m = 2\n");
  wrong.kind.reset();
  expect_refusal(4, "max_m", [&] { lay(camera_, {wrong}); });
}

TEST_F(Layered, RefusesCrossedLimitsAtTheLayerThatSetThem) {
  const SensorProfile crossed = layer("range", "dropout_probability = 0\nmin_m = 4\n");
  expect_refusal(5, "range", [&] { lay(range_, {crossed}); });
  EXPECT_NO_THROW(lay(range_, {layer("range", "min_m = 5\n"), layer("range", "max_m = 9\n")}))
      << "limits may cross between layers";
}

TEST_F(Layered, RefusesAShutterLongerThanThePeriodAtTheLastLayerThatSetOne) {
  const std::string slow = "timing = \"periodic\"\nrate_hz = 10\n";
  const std::string fast = "noise = {}\ntiming = \"periodic\"\nrate_hz = 20\n";
  const std::string on_demand = "timing = \"on_demand\"\n";
  const auto open = [&](const std::vector<std::string>& layers) {
    sim::Sensor camera = make_camera("camera");
    std::vector<SensorProfile> entries;
    for (const std::string& lines : layers) entries.push_back(layer("camera", lines));
    lay(camera, entries);
  };
  EXPECT_NO_THROW(open({slow + "exposure_ms = 100\nreadout_ms = 100\n"}));
  EXPECT_NO_THROW(open({on_demand + "exposure_ms = 600\n", "readout_ms = 400\n"}));
  expect_refusal(4, "camera", [&] { open({"exposure_ms = 34\n"}); });
  expect_refusal(4, "camera", [&] { open({"readout_ms = 34\n"}); });
  expect_refusal(5, "camera", [&] { open({slow + "exposure_ms = 90\n", fast}); });
  expect_refusal(4, "camera", [&] {
    open({on_demand + "exposure_ms = 600\n", "readout_ms = 401\n"});
  });
}

}  // namespace
}  // namespace tether::scenario
