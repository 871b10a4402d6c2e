#include "profile_text.h"

#include <cmath>

#include <gmock/gmock.h>
#include <toml++/toml.h>

namespace tether::sut {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

MeasuredProfile profile_of(std::vector<ProfiledSensor> sensors) {
  return {.name = "pi",
          .when = "2025-03-01T12:00:00Z",
          .where = "bench-pi",
          .acquisitions = 100,
          .experiments = 10,
          .sensors = std::move(sensors)};
}

std::vector<Duration> delays_of(const toml::node_view<toml::node>& sensor) {
  std::vector<Duration> delays;
  for (const toml::node& node : *sensor["delay"]["samples_ms"].as_array()) {
    delays.emplace_back(std::llround(*node.value<double>() * 1e6));
  }
  return delays;
}

TEST(ProfileText, KeepsEverySampleToTheNanosecond) {
  std::vector<Duration> delays = {Duration(0), Duration(1), Duration(33'100'000),
                                  Duration(1'000'000), Duration(999'999)};
  for (std::int64_t i = 1; i < 2000; ++i) {
    delays.emplace_back(i * 7'919'311 % 1'000'000'007);
  }
  delays.emplace_back(std::chrono::hours(1) + Duration(1));
  toml::table file = toml::parse(profile_text(
      profile_of({{"range", uav::SensorKind::kRange, "iio:vl53l0x", {std::nullopt, delays}}})));
  EXPECT_EQ(delays_of(file["sensors"]["range"]), delays);
  EXPECT_EQ(file["name"].value<std::string>(), "pi");
  EXPECT_EQ(file["sensors"]["range"]["kind"].value<std::string>(), "range");
  EXPECT_EQ(file["sensors"]["range"]["timing"].value<std::string>(), "on_demand");
  EXPECT_FALSE(file["sensors"]["range"]["period_ms"]);
  EXPECT_EQ(file["sensors"]["range"]["delay"]["kind"].value<std::string>(), "empirical");
}

TEST(ProfileText, APeriodicSensorHasItsPeriod) {
  toml::table file = toml::parse(profile_text(profile_of(
      {{"camera", uav::SensorKind::kCamera, "/dev/video0", {Duration(33'333'333), {Duration(5)}}},
       {"imu", uav::SensorKind::kImu, "virtual", {std::nullopt, {Duration(7)}}}})));
  EXPECT_EQ(file["sensors"]["camera"]["timing"].value<std::string>(), "periodic");
  EXPECT_EQ(file["sensors"]["camera"]["period_ms"].value<double>(), 33.333333);
  EXPECT_EQ(file["sensors"]["imu"]["kind"].value<std::string>(), "imu");
}

TEST(ProfileText, SaysWhereItIsFrom) {
  const std::string text = profile_text(profile_of(
      {{"camera", uav::SensorKind::kCamera, "/dev/video0", {std::nullopt, {Duration(5)}}}}));
  EXPECT_THAT(text, StartsWith("# Measured by tether-sut "));
  EXPECT_THAT(text, HasSubstr("on bench-pi, 2025-03-01T12:00:00Z."));
  EXPECT_THAT(text, HasSubstr("10 experiments of 100 acquisitions each"));
  EXPECT_THAT(text, HasSubstr("# /dev/video0, 1 measured\n"));
}

TEST(ProfileText, NamesCannotBreakIt) {
  toml::table file = toml::parse(profile_text(profile_of({{"my \"eye\"\\ 2.0",
                                                           uav::SensorKind::kCamera,
                                                           "/dev/a\nkind = 3",
                                                           {std::nullopt, {Duration(5)}}}})));
  EXPECT_EQ(file["sensors"].as_table()->size(), 1u);
  EXPECT_TRUE(file["sensors"]["my \"eye\"\\ 2.0"].is_table());
}

TEST(ProfileName, IsAnIdentifier) {
  for (const char* good : {"pi", "pi-4_b.1", "0"}) {
    EXPECT_TRUE(is_profile_name(good)) << good;
  }
  for (const std::string& bad : {std::string(), std::string(".pi"), std::string("my pi"),
                                 std::string(65, 'a'), std::string("pi\n")}) {
    EXPECT_FALSE(is_profile_name(bad)) << bad;
    EXPECT_TRUE(is_profile_name(profile_name_from(bad))) << bad;
  }
  EXPECT_EQ(profile_name_from("my pi"), "my_pi");
}

}  // namespace
}  // namespace tether::sut
