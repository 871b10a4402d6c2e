#include "contacts.h"

#include "flight.h"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/campaign_testing/sample_campaign.h>

namespace tether::campaign {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;

SimTime contact_at(std::int64_t ms) {
  return SimTime(milliseconds(ms));
}

// "uav1" rests on the floor, then hits the room's wall; "uav2" lands.
record::Record crashed_record() {
  record::Record record = Flight().pose(0, 0.0, 0.0, 0.0).finish(3000).record();
  record.header.suts = {{.uav = "uav1", .sut = "sut"}, {.uav = "uav2", .sut = "sut"}};
  record.header.reports_contacts = true;
  const record::Contact contacts[] = {{"uav1", contact_at(0), "room", 0.0},
                                      {"uav2", contact_at(900), "floor", 0.4},
                                      {"uav1", contact_at(2100), "room", 3.8},
                                      {"uav1", contact_at(2500), "shelf", 0.9}};
  for (const record::Contact& contact : contacts) record.contacts.push_back({{}, 0, contact});
  record.footer.emplace().end = "finished";
  record.footer->clearances = {{"uav1", 0.0, contact_at(0), "room"}};
  return record;
}

TEST(Contacts, AreCountedForEachUav) {
  const record::Record record = crashed_record();
  const std::vector<UavContacts> expected = {
      {"uav1", 3, 2, record.contacts[2].message, record.footer->clearances[0]},
      {"uav2", 1, 0, record.contacts[1].message, {}}};
  EXPECT_EQ(contacts_of(record, 0.5), expected);
}

// Also those of earlier versions.
TEST(Contacts, AreUnknownInARecordThatDoesNotReportThem) {
  record::Record record = crashed_record();
  record.header.reports_contacts = false;
  record.contacts.clear();
  record.footer->clearances.clear();
  EXPECT_EQ(contacts_of(record, 0.5), (std::vector<UavContacts>{{"uav1"}, {"uav2"}}));
}

struct CrashCase {
  const char* name;
  double max_speed_m_s;
  const char* end;
  bool reached_goal;
  std::vector<const char*> reason;  ///< has these in this order; none: the goal is reached
};

class CrashTest : public testing::TestWithParam<CrashCase> {};

TEST_P(CrashTest, MissesTheGoal) {
  const CrashCase& c = GetParam();
  const ScratchFolder scratch;
  scenario::Campaign campaign = make_campaign(scratch);
  scenario::Scenario& scenario = campaign.scenarios[0].scenario;
  scenario.max_contact_speed_m_s = c.max_speed_m_s;
  scenario.metrics = {{"collisions", "collisions", "Collisions", "1", "uav1", "", 0.0, {}}};
  scenario.metrics[0].threshold_m_s = 0.5;
  scenario.metrics[0].of_any_flight = true;
  record::Record record = crashed_record();
  record.footer->end = c.end;
  record.footer->reason = "too late";
  const TrialResult result =
      make_result(scenario, scenario.conditions[0], record,
                  {{"uav1", c.reached_goal, "lost sight", ""}, {"uav2", true, "", ""}});
  EXPECT_EQ(result.outcome, c.reason.empty() ? Outcome::kGoalReached : Outcome::kGoalMissed);
  std::size_t from = 0;
  for (const char* part : c.reason) {
    from = result.reason.find(part, from);
    EXPECT_NE(from, std::string::npos) << result.reason;
  }
  EXPECT_EQ(result.contacts.size(), 2u);
  EXPECT_EQ(result.metrics[0].value, 2.0);
}

constexpr double kInf = std::numeric_limits<double>::infinity();
const std::vector<CrashCase> kCrashCases = {
    {"AtTheDefault", 0.5, "finished", true, {"'uav1' hit 'room' at ST 2.1 s with 3.8 m/s"}},
    {"TheFirstCounts", 0.3, "finished", true, {"'uav2' hit 'floor' at ST 0.9 s"}},
    {"BeforeOtherReasons", 0.5, "finished", false, {"hit 'room'", "lost sight"}},
    {"BeforeTheTimeLimit", 0.5, "time_limit", true, {"hit 'room'", "too late"}},
    {"AtTheLimitItIsAllowed", 3.8, "finished", true, {}},
    {"AllAllowed", kInf, "finished", true, {}},
};

INSTANTIATE_TEST_SUITE_P(Limits, CrashTest, testing::ValuesIn(kCrashCases),
                         [](const auto& named) { return named.param.name; });

TEST(ContactMetrics, HaveNoValueIfTheRecordHasNone) {
  Flight flight;
  EXPECT_FALSE(flight.metric("collisions").value);
  EXPECT_FALSE(flight.metric("min_clearance_m").value);
  flight.record() = crashed_record();
  EXPECT_EQ(flight.metric("collisions").value, 2.0) << "more than 0 m/s";
  EXPECT_EQ(flight.metric("min_clearance_m").value, 0.0);
}

}  // namespace
}  // namespace tether::campaign
