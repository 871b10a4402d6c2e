#include "checks.h"
#include "report.h"

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include <gmock/gmock.h>

namespace tether::audit {
namespace {

using record::Record;
using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

void turn(Record& record, std::int64_t at_ms, double angle_rad) {
  record::CommandEffect m;
  m.uav = "a";
  m.sequence = 1;
  m.applied_at = SimTime(milliseconds(at_ms));
  m.setpoint = record::Setpoint{.mask = 512, .joints_rad = {angle_rad}};
  record.commands.push_back({m.applied_at, 0, m});
}

// 1 rad/s: to 0.5 rad from 5 ms on, back from 25 ms on, and to 0.01 rad from 40 ms on.
Record turning_record() {
  Record record;
  record.header.step = milliseconds(1);
  record.header.suts.emplace_back().uav = "a";
  record.header.suts[0].joints = {{"pitch", {}, {0, 1, 0}, -1, 1, 1}};
  turn(record, 5, 0.5);
  turn(record, 25, -0.5);
  turn(record, 40, 0.01);
  const double angles_rad[] = {0, 0.005, 0.015, 0.015, 0.005, 0.01, 0.01};
  for (int i = 0; i < 7; ++i) {
    record::GroundTruth m;
    m.uav = "a";
    m.at = SimTime(milliseconds(10 * i));
    m.joints_rad = {angles_rad[i]};
    record.ground_truth.push_back({m.at, 0, m});
  }
  return record;
}

std::vector<std::string> findings_after(const std::function<void(Record&)>& change) {
  Record record = turning_record();
  change(record);
  Verdict verdict;
  Report report(verdict);
  check_joints(record, report);
  std::vector<std::string> texts;
  for (const Finding& finding : verdict.findings) texts.push_back(finding.what);
  return texts;
}

TEST(AuditJoints, TurnAsTheyWereCommanded) {
  EXPECT_THAT(findings_after([](Record&) {}), IsEmpty());
}

TEST(AuditJoints, ThatTurnOtherwiseAreReportedOnce) {
  EXPECT_THAT(findings_after([](Record& r) { r.commands.erase(r.commands.begin()); }),
              ElementsAre(HasSubstr("\"pitch\" is at 0.005 rad, but it was commanded to 0 rad"),
                          HasSubstr("0.015"), HasSubstr("0.015")));
  EXPECT_THAT(findings_after([](Record& r) { r.ground_truth[6].message.joints_rad[0] = 0.0101; }),
              ElementsAre(HasSubstr("0.0101")));
  EXPECT_THAT(findings_after([](Record& r) { r.header.suts[0].joints[0].max_rate_rad_s = 0.9; }),
              testing::Not(IsEmpty()));
}

TEST(AuditJoints, OfAFlightControllerTurnWithinTheirRateAndLimits) {
  const auto controlled = [](double max_rate_rad_s, double max_rad) {
    return findings_after([&](Record& r) {
      r.commands.clear();
      r.header.suts[0].controller.emplace();
      r.header.suts[0].joints[0].max_rate_rad_s = max_rate_rad_s;
      r.header.suts[0].joints[0].max_rad = max_rad;
    });
  };
  EXPECT_THAT(controlled(1.0, 1.0), IsEmpty());
  EXPECT_THAT(controlled(0.9, 1.0), ElementsAre(HasSubstr("goes from 0.005 rad to 0.015 rad"),
                                                HasSubstr("to 0.005 rad")));
  EXPECT_THAT(controlled(1.0, 0.01), ElementsAre(HasSubstr("0.015"), HasSubstr("0.015")));
}

TEST(AuditJoints, HaveAnAngleInEachMessage) {
  EXPECT_THAT(findings_after([](Record& r) { r.ground_truth[3].message.joints_rad.clear(); }),
              ElementsAre(HasSubstr("0 angles of 1 joints")));
}

}  // namespace
}  // namespace tether::audit
