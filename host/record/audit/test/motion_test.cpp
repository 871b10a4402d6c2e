#include "altered_record.h"
#include "checks.h"

#include <gtest/gtest.h>

namespace tether::audit {
namespace {

using record::Record;

// "a" of 0.5 kg rises with all that its rotors can do, and carries 0.5 kg from 10 to 20 ms.
Record rise(double most_m_s2, double loaded_m_s2) {
  Record record;
  record.header.step = kStep;
  record.header.reports_contacts = record.header.moves_by_forces = true;
  record.header.suts = {{.uav = "a", .sut = "s", .clock = {computer::ClockKind::kScripted}}};
  record.header.suts[0].max_acceleration_m_s2 = most_m_s2;
  record.header.suts[0].load = {0.5, 10.0, {{0.5, SimTime(10 * kStep), SimTime(20 * kStep)}}};
  record::GroundTruth truth;
  truth.uav = "a";
  for (const double acceleration_m_s2 : {0.0, most_m_s2, loaded_m_s2, most_m_s2}) {
    const double gained_m_s = acceleration_m_s2 * 10 * to_seconds(kStep);
    truth.p_WB_m[2] += 10 * to_seconds(kStep) * (truth.v_WB_m_s[2] + gained_m_s / 2.0);
    truth.v_WB_m_s[2] += gained_m_s;
    truth.at = SimTime(static_cast<int>(record.ground_truth.size()) * 10 * kStep);
    record.ground_truth.push_back({truth.at, 0, truth});
  }
  return record;
}

std::size_t motion_findings(const Record& record) {
  Verdict verdict;
  Report report(verdict);
  check_motion(record, report);
  return verdict.findings.size();
}

// 60 m/s² of its rotors alone are 30 with the payload; gravity's 10 stay.
TEST(AuditOfMotion, APayloadSlowsTheUavWhileItIsCarried) {
  EXPECT_EQ(motion_findings(rise(70.0, 40.0)), 0u);
  Record record = rise(70.0, 70.0);
  EXPECT_EQ(motion_findings(record), 1u) << "it never carried it";
  record.header.suts[0].load.reset();
  EXPECT_EQ(motion_findings(record), 0u);
  record = rise(70.0, 70.0);
  record.header.suts[0].load->payloads[0].until = SimTime(19 * kStep);
  EXPECT_EQ(motion_findings(record), 0u) << "dropped before the next message";
}

}  // namespace
}  // namespace tether::audit
