#include "altered_record.h"
#include "checks.h"

#include <gtest/gtest.h>

namespace tether::audit {
namespace {

using record::Record;

// "a" falls at 1 m/s: 10 mm over the floor at 0 ms, and on it at 10 ms.
Record landing() {
  Record record;
  record.header.step = kStep;
  record.header.reports_contacts = record.header.only_uavs_move = record.header.moves_by_forces =
      true;
  record.header.suts = {{.uav = "a", .sut = "s", .clock = {computer::ClockKind::kScripted}}};
  record.header.suts[0].max_acceleration_m_s2 = 30.0;
  record.header.suts[0].extent_m = 0.2;
  for (const int ms : {0, 10, 20}) {
    record::GroundTruth truth{.uav = "a", .at = SimTime(ms * kStep)};
    truth.v_WB_m_s[2] = ms == 0 ? -1.0 : 0.0;
    truth.clearance_m = ms == 0 ? 0.01 : 0.0;
    record.ground_truth.push_back({truth.at, 0, truth});
  }
  record.contacts.push_back({SimTime(10 * kStep), 0, {"a", SimTime(9 * kStep), "floor", 1.05}});
  record.footer.emplace().st_at_end = SimTime(200 * kStep);
  return record;
}

std::size_t contact_findings(const Record& record) {
  Verdict verdict;
  Report report(verdict);
  check_contacts(record, report);
  return verdict.findings.size();
}

TEST(AuditOfContacts, FindsWhatTheGroundTruthContradicts) {
  EXPECT_EQ(contact_findings(landing()), 0u);
  Record record = landing();
  record.contacts.clear();
  EXPECT_EQ(contact_findings(record), 1u);
  record.footer->st_at_end = SimTime(20 * kStep);
  EXPECT_EQ(contact_findings(record), 0u) << "what finds the contact was not flown";
  record = landing();
  record.contacts[0].at = SimTime(20 * kStep);
  EXPECT_EQ(contact_findings(record), 1u) << "recorded late";
  record = landing();
  record.contacts[0].message.speed_m_s = 3.0;
  EXPECT_EQ(contact_findings(record), 1u);
  record.header.moves_by_forces = false;
  EXPECT_EQ(contact_findings(record), 0u) << "velocities may jump";
}

}  // namespace
}  // namespace tether::audit
