#include <atomic>
#include <barrier>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include <tether/campaign/run_campaign.h>
#include <tether/campaign_testing/sample_campaign.h>
#include <tether/os/text_file.h>

namespace tether::campaign {
namespace {

using std::chrono::seconds;

class RunCampaign : public testing::Test {
 protected:
  CampaignFolder open(OpenMode mode = OpenMode::kFresh) const {
    return CampaignFolder(out_, campaign_, {}, mode);
  }
  CampaignOutcome run(const CampaignFolder& folder, const TrialExecutor& execute) {
    return run_campaign(folder, campaign_, execute, options_, [&](const CampaignProgress& now) {
      progress_.push_back(now);
      if (now.result != nullptr) ended_.push_back(folder_of(*now.latest));
    });
  }
  std::string folder_of(const TrialPlan& plan) const {
    return plan.folder.lexically_relative(out_).string();
  }
  static TrialResult good(const TrialPlan& plan) {
    return make_trial(*plan.scenario, plan.condition->name, plan.seed, 0.0, 2.5);
  }
  TrialResult result_of(std::size_t trial) const {
    return read_result(plan_trials(campaign_, out_)[trial].folder);
  }

  ScratchFolder scratch_;
  std::filesystem::path out_ = scratch_.path("out");
  scenario::Campaign campaign_ = make_campaign(scratch_);
  CampaignOptions options_;
  std::vector<CampaignProgress> progress_;
  std::vector<std::string> ended_;
};

TEST_F(RunCampaign, RunsEverythingOnceInAnEmptyFolder) {
  open();
  scratch_.write("out/turn/host/seed-0001/record.mcap", "cut short");
  std::multiset<std::string> ran;
  const CampaignOutcome outcome = run(open(), [&](const TrialPlan& plan) {
    EXPECT_TRUE(std::filesystem::is_empty(plan.folder));
    ran.insert(folder_of(plan));
    return good(plan);
  });
  EXPECT_EQ(outcome.ran, 9u);
  EXPECT_EQ(outcome.failed, 0u);
  EXPECT_FALSE(outcome.interrupted);
  EXPECT_EQ(ran.size(), 9u);
  EXPECT_EQ(std::set<std::string>(ran.begin(), ran.end()).size(), 9u);
  EXPECT_EQ(result_of(4).condition, "target");
  EXPECT_EQ(ended_.front(), "turn/host/seed-0001");
  EXPECT_EQ(ended_.back(), "turn/target-no-sync/seed-0003");
}

TEST_F(RunCampaign, RunsSomeOfTheMissingTrials) {
  const CampaignFolder folder = open();
  const std::vector<const TrialPlan*> some = {&folder.missing()[4], &folder.missing()[7]};
  std::vector<std::size_t> totals;
  const CampaignOutcome outcome =
      run_trials(some, good, options_,
                 [&](const CampaignProgress& progress) { totals.push_back(progress.total); });
  EXPECT_EQ(outcome.ran, 2u);
  EXPECT_EQ(totals, (std::vector<std::size_t>(4, 2)));
  EXPECT_EQ(result_of(4).outcome, Outcome::kGoalReached);
  EXPECT_FALSE(std::filesystem::exists(folder.missing()[0].folder));
}

TEST_F(RunCampaign, ResumesAfterAStopWithoutTheTrialThatWasStopped) {
  std::stop_source stop;
  options_.stop = stop.get_token();
  const CampaignOutcome first = run(open(), [&](const TrialPlan& plan) {
    TrialResult result = good(plan);
    if (plan.seed == 2 && stop.request_stop()) result.end = kEndInterrupted;
    return result;
  });
  EXPECT_EQ(first.ran, 2u);
  EXPECT_TRUE(first.interrupted);

  options_.stop = {};
  progress_.clear();
  EXPECT_EQ(run(open(OpenMode::kResume), good).ran, 7u);
  EXPECT_EQ(progress_.front().done, 2u);
  EXPECT_EQ(progress_.back().done, 9u);
  EXPECT_TRUE(open(OpenMode::kResume).missing().empty());
}

TEST_F(RunCampaign, RetriesASetUpFailureOnceAndKeepsItsLog) {
  const std::string log(kTrialLog);
  std::map<std::string, int> attempts;
  const CampaignOutcome outcome = run(open(), [&](const TrialPlan& plan) {
    const std::string folder = folder_of(plan);
    if (++attempts[folder] == 1 && plan.seed == 2) {
      scratch_.write("out/" + folder + "/" + log, "no port");
      scratch_.write("out/" + folder + "/record.mcap", "cut short");
      throw Error(ErrorCode::kSetup, "the port was taken");
    }
    EXPECT_FALSE(std::filesystem::exists(plan.folder / "record.mcap"));
    return good(plan);
  });
  EXPECT_EQ(outcome.failed, 0u);
  EXPECT_EQ(attempts["turn/host/seed-0001"], 1);
  EXPECT_EQ(attempts["turn/host/seed-0002"], 2);
  EXPECT_EQ(result_of(0).this_run.attempts, 1);
  EXPECT_EQ(result_of(3).this_run.attempts, 2);
  EXPECT_EQ(result_of(3).this_run.first_failure, "the port was taken");
  EXPECT_EQ(result_of(3).outcome, Outcome::kGoalReached);
  EXPECT_EQ(os::read_file(plan_trials(campaign_, out_)[3].folder / log), "no port");
}

TEST_F(RunCampaign, KeepsATrialThatFailedTwiceAndDoesNotRetryALostSut) {
  int calls = 0;
  const CampaignOutcome outcome = run(open(), [&](const TrialPlan& plan) {
    ++calls;
    if (plan.seed == 1) return good(plan);
    auto failed = make_setup_failure(*plan.scenario, *plan.condition, plan.seed, "no simulator");
    if (plan.seed == 3) failed.end = "sut_lost";
    return failed;
  });
  EXPECT_EQ(calls, 3 + 2 * 3 + 3);
  EXPECT_EQ(outcome.ran, 9u);
  EXPECT_EQ(outcome.failed, 6u);
  EXPECT_EQ(result_of(3).reason, "no simulator");
  EXPECT_EQ(result_of(3).this_run.attempts, 2);
}

TEST_F(RunCampaign, EndsWithAnErrorOfTheUsersFilesAndDoesNotKeepThatTrial) {
  int checks = 0;
  options_.check = [&] {
    if (++checks == 3) throw Error(ErrorCode::kBadFile, "changed").about("room.sdf");
  };
  const auto execute = [&](const TrialPlan& plan) {
    if (checks == 4) throw Error(ErrorCode::kBadFile, "broken").about("mesh.obj");
    write_result(plan.folder, good(plan));  // as a child process does
    return good(plan);
  };
  EXPECT_EQ(bad_file_error([&] { run(open(), execute); }).subject(), "room.sdf");
  EXPECT_EQ(checks, 3);
  EXPECT_EQ(open(OpenMode::kResume).finished().size(), 2u);
  const auto resume = [&] { run(open(OpenMode::kResume), execute); };
  EXPECT_EQ(bad_file_error(resume).subject(), "mesh.obj");
  EXPECT_EQ(open(OpenMode::kResume).finished().size(), 3u);
}

TEST_F(RunCampaign, RunsTrialsInParallelIfTheyMayAndOthersAlone) {
  options_.jobs = 2;
  // A free-running SUT that is always busy.
  campaign_.scenarios[0].scenario.conditions[2].computers[0].clock.factor = 1.0;
  campaign_.scenarios[0].scenario.conditions[2].real_time_factor = 1.0;
  std::barrier both(2);
  std::atomic<int> inside{0};
  run(open(), [&](const TrialPlan& plan) {
    const int others = inside++;
    if (parallel_trials(plan, options_.jobs) > 1) {
      both.arrive_and_wait();  // would wait for ever if it ran alone
    } else {
      EXPECT_EQ(others, 0);
    }
    --inside;
    return good(plan);
  });
  EXPECT_TRUE(open(OpenMode::kResume).missing().empty());
}

TEST_F(RunCampaign, RefusesJobsBeforeAnythingRuns) {
  options_.jobs = 0;
  const auto execute = [](const TrialPlan& plan) {
    ADD_FAILURE();
    return good(plan);
  };
  EXPECT_EQ(thrown_error(ErrorCode::kUsage, [&] { run(open(), execute); }).subject(), "--jobs");
}

TEST_F(RunCampaign, ReportsItsProgress) {
  Duration now{0};
  options_.wall = [&] { return now; };
  run(open(), [&](const TrialPlan& plan) {
    now += seconds(plan.condition->name == "host" ? 1 : 4);
    return good(plan);
  });
  ASSERT_EQ(progress_.size(), 18u);  // start and end of each
  EXPECT_EQ(progress_[0].running, 1u);
  EXPECT_EQ(progress_[0].total, 9u);
  EXPECT_FALSE(progress_[0].time_left);
  EXPECT_EQ(progress_[1].done, 1u);
  EXPECT_EQ(progress_[1].running, 0u);
  // host and target are known: 2 × 1 + 2 × 4, and 3 others at the mean of both, 2.5.
  EXPECT_EQ(progress_[3].time_left, std::chrono::milliseconds(17'500));
  EXPECT_EQ(progress_.back().time_left, Duration{0});
}

}  // namespace
}  // namespace tether::campaign
