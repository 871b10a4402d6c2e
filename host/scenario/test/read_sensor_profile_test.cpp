#include "read_sensor_profile.h"

#include "full_profile.h"
#include "full_scenario.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base/units.h>

namespace tether::scenario {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::HasSubstr;

class ReadSensorProfile : public testing::Test {
 protected:
  SensorProfile sensor(const std::string& name, const std::string& text = kFullProfile) const {
    return load_profile(scratch_.write("p.toml", text)).sensors.at(name);
  }
  std::string error_with(const std::string& from, const std::string& to) const {
    return bad_file_message([&] { sensor("camera", replaced(kFullProfile, from, to)); });
  }
  ScratchFolder scratch_;
};

TEST_F(ReadSensorProfile, ReadsACamera) {
  const SensorProfile camera = sensor("camera");
  EXPECT_EQ(camera.kind, uav::SensorKind::kCamera);
  EXPECT_EQ(camera.p_BS, (uav::Vec3{0.1, 0.2, -0.05}));
  EXPECT_EQ(camera.q_BS, uav::from_rpy(0.0, rad_from_deg(90), 0.0));
  EXPECT_EQ(camera.size->width_px, 320);
  EXPECT_EQ(camera.size->height_px, 200);
  EXPECT_DOUBLE_EQ(*camera.horizontal_fov_rad, rad_from_deg(90));
  EXPECT_DOUBLE_EQ(*camera.exposure_s, 0.008);
  EXPECT_DOUBLE_EQ(*camera.readout_s, 0.0125);
  EXPECT_EQ(camera.distortion->k1, -0.25);
  EXPECT_EQ(camera.distortion->k2, 0.06);
  EXPECT_EQ(camera.distortion->k3, 0.01);
  EXPECT_EQ(camera.distortion->p1, 0.002);
  EXPECT_EQ(camera.distortion->p2, -0.001);
  EXPECT_EQ(camera.pixel_noise->mean, 0.01);
  EXPECT_EQ(camera.pixel_noise->stddev, 0.02);
  EXPECT_EQ(camera.pixel_noise->bias_mean, 0.03);
  EXPECT_EQ(camera.pixel_noise->bias_stddev, 0.04);
  EXPECT_EQ(camera.pixel_noise->dynamic_bias_stddev, 0.05);
  EXPECT_EQ(camera.pixel_noise->dynamic_bias_correlation_time_s, 60.0);
  EXPECT_FALSE(camera.range_noise);
}

TEST_F(ReadSensorProfile, ReadsAnImuAndARangefinder) {
  const SensorProfile imu = sensor("imu"), range = sensor("range");
  EXPECT_EQ(imu.kind, uav::SensorKind::kImu);
  EXPECT_EQ(imu.angular_velocity_noise->stddev, 0.001);
  EXPECT_EQ(imu.angular_velocity_noise->bias_stddev, 0.002);
  EXPECT_EQ(imu.linear_acceleration_noise->stddev, 0.01);
  EXPECT_FALSE(imu.p_BS || imu.q_BS);
  EXPECT_EQ(range.kind, uav::SensorKind::kRange);
  EXPECT_EQ(range.min_m, 0.05);
  EXPECT_EQ(range.max_m, 3.0);
  EXPECT_EQ(range.resolution_m, 0.001);
  EXPECT_DOUBLE_EQ(*range.field_of_view_rad, rad_from_deg(27));
  EXPECT_EQ(range.dropout_probability, 0.125);
  EXPECT_EQ(range.range_noise->mean, 0.01);
  EXPECT_EQ(range.range_noise->stddev, 0.005);
}

TEST_F(ReadSensorProfile, ReadsTimings) {
  const auto camera = std::get<uav::PeriodicTiming>(*sensor("camera").timing);
  EXPECT_EQ(camera.period, milliseconds(40));
  EXPECT_EQ(camera.phase, milliseconds(4));
  EXPECT_THAT(std::get<uav::EmpiricalDelay>(camera.delay).samples,
              ElementsAre(Duration(33'100'000), Duration(33'400'000)));
  const auto imu = std::get<uav::PeriodicTiming>(*sensor("imu").timing);
  EXPECT_EQ(imu.period, milliseconds(50));
  EXPECT_EQ(std::get<uav::NormalDelay>(imu.delay).stddev, Duration(1'500'000));
  const auto range = std::get<uav::OnDemandTiming>(*sensor("range").timing);
  EXPECT_EQ(std::get<uav::ConstantDelay>(range.delay).value, Duration(97'700'000));
}

TEST_F(ReadSensorProfile, ReadsADelayWithoutATiming) {
  const SensorProfile range =
      sensor("range", replaced(kFullProfile, "timing = \"on_demand\"\n", ""));
  EXPECT_FALSE(range.timing);
  EXPECT_EQ(std::get<uav::ConstantDelay>(*range.delay).value, Duration(97'700'000));
}

TEST_F(ReadSensorProfile, AnEmptyNoiseIsNoNoise) {
  const SensorProfile range = sensor(
      "range", replaced(kFullProfile, "noise_m = { mean = 0.01, stddev = 0.005 }", "noise_m = {}"));
  ASSERT_TRUE(range.range_noise);
  EXPECT_EQ(range.range_noise->mean, 0.0);
  EXPECT_EQ(range.range_noise->stddev, 0.0);
}

TEST_F(ReadSensorProfile, KnowsWhereEachKeyStands) {
  const SensorProfile camera = sensor("camera");
  EXPECT_EQ(camera.where.line, 4);
  EXPECT_EQ(camera.at("exposure_ms").line, 14);
  EXPECT_EQ(camera.at("distortion").line, 17);
  EXPECT_EQ(camera.at("min_m").line, 4);
}

TEST_F(ReadSensorProfile, RefusesKeysOfAnotherKind) {
  EXPECT_THAT(error_with("rate_hz = 25", "rate_hz = 25\nmin_m = 1"),
              HasSubstr("p.toml:8: 'min_m' goes with the kind \"range\", but the sensor 'camera' "
                        "is of the kind \"camera\"; Allowed: 'kind', 'timing', "));
  EXPECT_THAT(error_with("min_m = 0.05", "exposure_ms = 3"),
              HasSubstr("'exposure_ms' goes with the kind \"camera\""));
  EXPECT_THAT(error_with("min_m = 0.05", "angular_velocity_noise_rad_s = {}"),
              HasSubstr("goes with the kind \"imu\""));
}

TEST_F(ReadSensorProfile, RefusesImpossibleOptics) {
  EXPECT_THAT(error_with("_deg = 90", "_deg = 180"),
              HasSubstr("must be greater than 0 and less than 180, but is 180"));
  EXPECT_THAT(error_with("_deg = 90", "_deg = 0"), HasSubstr("but is 0"));
  EXPECT_THAT(error_with("[320, 200]", "[320]"), HasSubstr("must be [width, height], but has 1"));
  EXPECT_THAT(error_with("[320, 200]", "[320, 0]"), HasSubstr("at least 1, but has 0"));
  EXPECT_THAT(error_with("[320, 200]", "[4097, 1]"), HasSubstr("at most 4096 each, but has 4097"));
  EXPECT_THAT(error_with("[320, 200]", "[320.5, 1]"), HasSubstr("an array of integers"));
  EXPECT_THAT(error_with("_view_deg = 27", "_view_deg = 180"),
              HasSubstr("at least 0 and less than 180"));
  EXPECT_THAT(error_with("exposure_ms = 8", "exposure_ms = -1"), HasSubstr("at least 0"));
}

TEST_F(ReadSensorProfile, RefusesImpossibleNumbers) {
  EXPECT_THAT(error_with("= 0.125", "= 1.5"), HasSubstr("at least 0 and at most 1, but is 1.5"));
  EXPECT_THAT(error_with("max_m = 3", "max_m = 0"), HasSubstr("greater than 0"));
  EXPECT_THAT(error_with("stddev = 0.02", "stddev = -0.02"), HasSubstr("at least 0"));
  EXPECT_THAT(error_with("time_s = 60", "time_s = 0"),
              HasSubstr("lacks the key 'dynamic_bias_correlation_time_s', greater than 0"));
  EXPECT_THAT(error_with("{ stddev = 0.01 }", "{ stdev = 0.01 }"),
              HasSubstr("did you mean 'stddev'?"));
  EXPECT_THAT(error_with("ms = 97.7", "ms = -1"), HasSubstr("at least 0"));
}

TEST_F(ReadSensorProfile, RefusesHalfATiming) {
  EXPECT_THAT(error_with("timing = \"periodic\"\nrate_hz = 25", "rate_hz = 25"),
              HasSubstr("p.toml:4: [sensors.camera] lacks the key 'timing': 'rate_hz' goes with"));
  EXPECT_THAT(error_with("timing = \"on_demand\"", "timing = \"on_demand\"\nphase_ms = 1"),
              HasSubstr("'phase_ms' of [sensors.range] goes with timing = \"periodic\", but"));
  EXPECT_THAT(error_with("rate_hz = 25", "rate_hz = 25\nperiod_ms = 40"),
              HasSubstr("either 'rate_hz' or 'period_ms'"));
}

TEST_F(ReadSensorProfile, RequireKindTakesWhatFits) {
  SensorProfile layer;
  layer.where = {"p.toml", 3};
  layer.lines = {{"timing", 4}, {"position_m", 5}, {"exposure_ms", 6}};
  EXPECT_NO_THROW(require_kind(layer, "eye", uav::SensorKind::kCamera));
  EXPECT_THAT(bad_file_message([&] { require_kind(layer, "eye", uav::SensorKind::kImu); }),
              HasSubstr("p.toml:6: 'exposure_ms' goes with the kind \"camera\", but the sensor "
                        "'eye' is of the kind \"imu\""));
}

}  // namespace
}  // namespace tether::scenario
