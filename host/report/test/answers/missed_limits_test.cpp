#include <gtest/gtest.h>

#include <tether/report/verdict.h>

namespace tether::report {
namespace {

std::string missed(const campaign::TrialResult& trial) {
  const campaign::TrialResult* const only = &trial;
  return missed_text(missed_limits({&only, 1}), true);
}

TEST(MissedLimits, SayWhatWasHitAndWhichProgramsHadNotEnded) {
  campaign::TrialResult trial;
  trial.outcome = campaign::Outcome::kGoalMissed;
  trial.end = campaign::kEndTimeLimit;
  campaign::SutResult done, late;
  done.uav = "uav1";
  done.finished = done.reached_goal = true;
  late.uav = "uav2";
  trial.suts = {late};
  EXPECT_EQ(missed(trial), "the time limit") << "there is no other program";
  trial.suts = {done, late};
  EXPECT_EQ(missed(trial), "the time limit: the program of uav2 had not ended");
  for (const double speed_m_s : {1.0, 3.0, 2.0}) {
    campaign::UavContacts& own = trial.contacts.emplace_back();
    own.hard = 1;
    record::Contact& hit = own.hardest.emplace();
    hit.uav = "uav2";
    hit.with = speed_m_s == 3.0 ? "wall" : "floor";
    hit.speed_m_s = speed_m_s;
  }
  EXPECT_EQ(missed(trial),
            "“no crash”: uav2 hit 'wall' and the time limit: the program of uav2 had not ended");
}

}  // namespace
}  // namespace tether::report
