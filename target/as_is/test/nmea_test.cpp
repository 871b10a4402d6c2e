#include "nmea.h"

#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::as_is {
namespace {

using testing::ElementsAre;
using testing::StartsWith;

constexpr Duration kAt = std::chrono::seconds(1'767'225'600) + std::chrono::milliseconds(45'250);

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream all(text);
  for (std::string line; std::getline(all, line);) {
    EXPECT_EQ(line.back(), '\r');
    line.pop_back();
    lines.push_back(line);
    unsigned sum = 0;
    for (std::size_t i = 1; i < line.find('*'); ++i) sum ^= static_cast<unsigned char>(line[i]);
    EXPECT_EQ(std::stoul(line.substr(line.find('*') + 1), nullptr, 16), sum) << line;
  }
  return lines;
}

TEST(Nmea, SaysPlaceSpeedCourseTimeAndAccuracy) {
  const uav::NavSatSample sample{.sampled_at = {},
                                 .has_fix = true,
                                 .latitude_deg = -33.8568,
                                 .longitude_deg = 8.5456,
                                 .altitude_m = 488.25,
                                 .velocity_ENU_m_s = {3.0, -4.0, 1.0},
                                 .horizontal_accuracy_m = 1.5,
                                 .vertical_accuracy_m = 2.5};
  EXPECT_THAT(
      lines_of(nmea_of(sample, kAt)),
      ElementsAre(
          StartsWith(
              "$GNGGA,000045.250,3351.4080000,S,00832.7360000,E,1,12,1.00,488.250,M,0.0,M,,*"),
          StartsWith("$GNRMC,000045.250,A,3351.4080000,S,00832.7360000,E,9.719,143.13,010126,,,A*"),
          StartsWith("$GNGST,000045.250,,,,,1.500,1.500,2.500*")));
}

TEST(Nmea, WithoutAFixHasNoPlace) {
  EXPECT_THAT(lines_of(nmea_of({}, kAt)),
              ElementsAre(StartsWith("$GNGGA,000045.250,,,,,0,00,99.99,,,,,,*"),
                          StartsWith("$GNRMC,000045.250,V,,,,,,,010126,,,N*"),
                          StartsWith("$GNGST,000045.250,,,,,,,*")));
}

// 59.99999999 minutes are the next degree.
TEST(Nmea, HasNoSixtyMinutes) {
  const uav::NavSatSample sample{.sampled_at = {},
                                 .has_fix = true,
                                 .latitude_deg = 9.99999999999,
                                 .longitude_deg = -179.99999999999};
  EXPECT_THAT(nmea_of(sample, kAt), testing::HasSubstr(",1000.0000000,N,18000.0000000,W,"));
}

}  // namespace
}  // namespace tether::as_is
