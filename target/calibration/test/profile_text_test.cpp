#include <cmath>

#include <gmock/gmock.h>
#include <toml++/toml.h>

#include <tether/calibration/characterize.h>

namespace tether::calibration {
namespace {

using ::testing::AllOf;
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

std::vector<Duration> delays_of(const ::toml::node_view<::toml::node>& sensor) {
  std::vector<Duration> delays;
  for (const ::toml::node& node : *sensor["delay"]["samples_ms"].as_array()) {
    delays.emplace_back(std::llround(*node.value<double>() * 1e6));
  }
  return delays;
}

TEST(ProfileText, KeepsEverySampleToTheNanosecond) {
  std::vector<Duration> delays = {Duration(0), Duration(1), Duration(33'100'000),
                                  Duration(1'000'000), Duration(999'999)};
  for (std::int64_t i = 1; i < 2000; ++i) delays.emplace_back(i * 7'919'311 % 1'000'000'007);
  delays.emplace_back(std::chrono::hours(1) + Duration(1));
  ::toml::table file = ::toml::parse(profile_text(
      profile_of({{"range", uav::SensorKind::kRange, "iio:vl53l0x", {std::nullopt, delays}}})));
  EXPECT_EQ(delays_of(file["sensors"]["range"]), delays);
  EXPECT_EQ(file["name"].value<std::string>(), "pi");
  EXPECT_EQ(file["sensors"]["range"]["kind"].value<std::string>(), "range");
  EXPECT_EQ(file["sensors"]["range"]["timing"].value<std::string>(), "on_demand");
  EXPECT_FALSE(file["sensors"]["range"]["period_ms"]);
  EXPECT_EQ(file["sensors"]["range"]["delay"]["kind"].value<std::string>(), "empirical");
}

TEST(ProfileText, APeriodicSensorHasItsPeriod) {
  ::toml::table file = ::toml::parse(profile_text(profile_of(
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

// Paths may have any bytes, and a text of TOML must be UTF-8 without control characters.
TEST(ProfileText, NoBytesCanBreakIt) {
  const std::vector<std::string> texts = {"\xFF/video0",      "a\xC3",
                                          "\xC0\xAF",         "\xE0\x80\x80",
                                          "\xED\xA0\x80",     "\xF4\x90\x80\x80",
                                          "\xF0\x9F\x98",     "\x80\x80",
                                          "a\tb\r\nc",        "\x7F\x1B[0m",
                                          "\xC2\x85",         "\xE2\x80\xA8",
                                          "\xEF\xBB\xBF\xFE", std::string("\0", 1),
                                          "/dev/a\nkind = 3"};
  for (const std::string& text : texts) {
    MeasuredProfile profile =
        profile_of({{text, uav::SensorKind::kCamera, text, {std::nullopt, {Duration(5)}}}});
    profile.where = text;
    ::toml::table file = ::toml::parse(profile_text(profile));
    EXPECT_EQ(file["sensors"].as_table()->size(), 1u) << ::testing::PrintToString(text);
  }
  for (int lead = 0x80; lead < 0x100; ++lead) {
    for (int next = 0x70; next < 0x100; ++next) {
      std::string text{static_cast<char>(lead), static_cast<char>(next)};
      text += "\x80\x80";
      const auto source = profile_text(
          profile_of({{"c", uav::SensorKind::kCamera, text, {std::nullopt, {Duration(5)}}}}));
      ASSERT_NO_THROW((void)::toml::parse(source)) << ::testing::PrintToString(text);
    }
  }
}

TEST(ProfileText, GoodTextStaysAsItIs) {
  const std::string name = "\xC3\xA9\xE2\x82\xAC\xF0\x9F\x98\x80";  // é, €, a smiley
  const std::string text = profile_text(
      profile_of({{name, uav::SensorKind::kCamera, name, {std::nullopt, {Duration(5)}}},
                  {"my \"eye\"\\ 2.0", uav::SensorKind::kImu, "x", {std::nullopt, {Duration(5)}}},
                  {"a\x01", uav::SensorKind::kImu, "x", {std::nullopt, {Duration(5)}}},
                  {"a\x02", uav::SensorKind::kImu, "x", {std::nullopt, {Duration(5)}}}}));
  EXPECT_THAT(text, HasSubstr("# " + name + ", 1 measured\n"));
  ::toml::table file = ::toml::parse(text);
  EXPECT_TRUE(file["sensors"][name].is_table());
  EXPECT_TRUE(file["sensors"]["my \"eye\"\\ 2.0"].is_table());
  EXPECT_TRUE(file["sensors"]["a\x01"].is_table() && file["sensors"]["a\x02"].is_table());
}

TEST(ProfileText, KeepsNoPassword) {
  const auto source_line = [](const std::string& device) {
    const std::string text = profile_text(
        profile_of({{"c", uav::SensorKind::kCamera, device, {std::nullopt, {Duration(5)}}}}));
    const std::size_t begin = text.find("\n# ", text.find("description")) + 3;
    return text.substr(begin, text.find(", 1 measured") - begin);
  };
  EXPECT_EQ(source_line("rtsp://me:secret@eye:554/0"), "rtsp://eye:554/0");
  EXPECT_EQ(source_line("rtsp://me:se@cret@eye"), "rtsp://eye");
  EXPECT_EQ(source_line("http://me@eye?at=a@b"), "http://eye?at=a@b");
  EXPECT_EQ(source_line("rtsp://eye/stream@2"), "rtsp://eye/stream@2");
  EXPECT_EQ(source_line("/dev/video@0"), "/dev/video@0");
}

TEST(ProfileText, RefusesDelayAboveTheMaximum) {
  const auto checked = [](Duration delay) {
    return check_delays(profile_of(
        {{"c", uav::SensorKind::kCamera, "x", {std::nullopt, {Duration(5), delay, Duration(6)}}}}));
  };
  EXPECT_TRUE(checked(std::chrono::seconds(60)));
  EXPECT_THAT(checked(std::chrono::milliseconds(60'001)).failure().message,
              AllOf(HasSubstr("\"c\""), HasSubstr("60001.0 ms")));
}

TEST(ProfileName, IsAnIdentifier) {
  for (const char* good : {"pi", "pi-4_b.1", "0"}) EXPECT_TRUE(is_profile_name(good)) << good;
  for (const std::string& bad : {std::string(), std::string(".pi"), std::string("my pi"),
                                 std::string(65, 'a'), std::string("pi\n")}) {
    EXPECT_FALSE(is_profile_name(bad)) << bad;
    EXPECT_TRUE(is_profile_name(profile_name_from(bad))) << bad;
  }
  EXPECT_EQ(profile_name_from("my pi"), "my_pi");
}

}  // namespace
}  // namespace tether::calibration
