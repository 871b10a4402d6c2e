#include "flight.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/judge/judge.h>

namespace tether::judge {
namespace {

using testing::HasSubstr;

mission::Mission watched_mission(const std::string& clauses) {
  const auto document = toml::Document::parse("[[task]]\ntask = \"t\"\n" + clauses, "m.toml");
  return mission::read_mission(document.root());
}

// The UAV of the record by hand rises by 1 m/s, and begins 3 m from the box.
TEST(FlightWatch, FindsTheFirstMissOfClausesThatEndTheFlight) {
  const mission::Mission watched = watched_mission(R"(
[[clause]]
always = "altitude <= 1 m"
[[clause]]
name = "too far"
always = "separation of box <= 5 m"
ends_flight = true
[[clause]]
never = "altitude >= 4.05 m"
ends_flight = true
[[clause]]
always = "from_start <= 0.5 m"
ends_flight = true
)");
  Flight flight;
  FlightWatch watch(watched, "uav1", flight.record());
  const auto miss = watch.look();
  ASSERT_TRUE(miss);
  EXPECT_EQ(miss->at, st(4.1));
  EXPECT_THAT(miss->reason, HasSubstr("\"too far\" ended the flight of \"uav1\" at ST 4.100 s"));
  EXPECT_THAT(miss->reason, HasSubstr("separation 5.08 m"));
  EXPECT_FALSE(watch.look()) << "nothing was added";
}

TEST(FlightWatch, NothingIsMissedAfterTheFinishOrByOthers) {
  const mission::Mission watched =
      watched_mission("[[clause]]\nalways = \"altitude <= 4 m\"\nends_flight = true\n");
  Flight flight;
  EXPECT_FALSE(FlightWatch(watched, "uav2", flight.record()).look());
  flight.finish(4.0);
  EXPECT_FALSE(FlightWatch(watched, "uav1", flight.record()).look());
}

TEST(FlightWatch, FromStartIsHorizontal) {
  const mission::Mission watched =
      watched_mission("[[clause]]\nalways = \"from_start <= 0.5 m\"\nends_flight = true\n");
  Flight flight;
  FlightWatch watch(watched, "uav1", flight.record());
  EXPECT_FALSE(watch.look()) << "it only rises";
  record::GroundTruth away = flight.record().ground_truth.back().message;
  away.p_WB_m[1] = 0.6;
  away.at = st(10.1);
  flight.record().ground_truth.push_back({away.at, 999, away});
  ASSERT_TRUE(watch.look());
}

}  // namespace
}  // namespace tether::judge
