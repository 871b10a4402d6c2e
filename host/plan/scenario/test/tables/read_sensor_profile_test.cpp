// That every key arrives at the sensor: layered_sensor_test.cpp.
#include "tables/read_sensor_profile.h"

#include "test_files.h"

#include <gtest/gtest.h>

namespace tether::scenario {
namespace {

class ReadSensorProfile : public testing::Test {
 protected:
  SensorProfile sensor_with(const std::string& name, const std::string& from,
                            const std::string& to) const {
    const auto file = scratch_.write("p.toml", replaced(kFullProfile, from, to));
    return load_profile(file).sensors.at(name);
  }
  void expect_refused(const std::vector<WrongChange>& changes) const {
    for (const WrongChange& change : changes)
      expect_refusal(change.line, change.subject,
                     [&] { sensor_with("camera", change.from, change.to); });
  }
  ScratchFolder scratch_;
};

TEST_F(ReadSensorProfile, ReadsADelayWithoutATiming) {
  const SensorProfile range = sensor_with("range", "timing = \"on_demand\"\n", "");
  EXPECT_FALSE(range.timing);
  EXPECT_EQ(std::get<uav::ConstantDelay>(*range.delay).value, Duration(97'700'000));
}

TEST_F(ReadSensorProfile, KnowsTheLineOfEachKey) {
  const SensorProfile camera = sensor_with("camera", "every key", "the same");
  EXPECT_EQ(camera.where.line, 4);
  EXPECT_EQ(camera.at("exposure_ms").line, 14);
  EXPECT_EQ(camera.at("antialias").line, 16);
  EXPECT_EQ(camera.at("distortion").line, 18);
  EXPECT_EQ(camera.at("min_m").line, 4);
}

TEST_F(ReadSensorProfile, RefusesKeysOfAnotherKind) {
  expect_refused(
      {{"rate_hz = 25", "rate_hz = 25\nresolution_m = 1", 8, "resolution_m"},
       {"min_m = 0.05", "exposure_ms = 3", 45, "exposure_ms"},
       {"min_m = 0.05", "antialias = true", 45, "antialias"},
       {"min_m = 0.05", "angular_velocity_noise_rad_s = {}", 45, "angular_velocity_noise_rad_s"}});
  SensorProfile layer;
  layer.where = {"p.toml", 3};
  layer.lines = {{"timing", 4}, {"position_m", 5}, {"exposure_ms", 6}};
  EXPECT_NO_THROW(require_kind(layer, "eye", uav::SensorKind::kCamera));
  expect_refusal(6, "exposure_ms", [&] { require_kind(layer, "eye", uav::SensorKind::kImu); });
}

TEST_F(ReadSensorProfile, RefusesImpossibleValues) {
  expect_refused({{"_deg = 90", "_deg = 180", 13, "horizontal_fov_deg"},
                  {"_deg = 90", "_deg = 0.2", 13, "horizontal_fov_deg"},
                  {"[320, 200]", "[320]", 12, "size_px"},
                  {"[320, 200]", "[320, 0]", 12, "size_px"},
                  {"[320, 200]", "[4097, 1]", 12, "size_px"},
                  {"[320, 200]", "[320.5, 1]", 12, "size_px"},
                  {"_view_deg = 27", "_view_deg = 180", 48, "field_of_view_deg"},
                  {"exposure_ms = 8", "exposure_ms = -1", 14, "exposure_ms"},
                  {"antialias = true", "antialias = 4", 16, "antialias"},
                  {"= 0.125", "= 1.5", 49, "dropout_probability"},
                  {"max_m = 3", "max_m = 0", 46, "max_m"},
                  {"stddev = 0.02", "stddev = -0.02", 27, "stddev"},
                  {"time_s = 60", "time_s = 0", 31, "dynamic_bias_correlation_time_s"},
                  {"{ stddev = 0.01 }", "{ stdev = 0.01 }", 39, "stdev"},
                  {"ms = 97.7", "ms = -1", 44, "ms"}});
}

TEST_F(ReadSensorProfile, RefusesAnIncompleteTiming) {
  expect_refused(
      {{"timing = \"periodic\"\nrate_hz = 25", "rate_hz = 25", 4, "timing"},
       {"timing = \"on_demand\"", "timing = \"on_demand\"\nphase_ms = 1", 44, "phase_ms"},
       {"rate_hz = 25", "rate_hz = 25\nperiod_ms = 40", 4, "[sensors.camera]"}});
}

}  // namespace
}  // namespace tether::scenario
