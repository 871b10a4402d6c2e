#include "fake_cluster.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base_testing/thrown_error.h>
#include <tether/workers/cluster.h>

namespace tether::workers {
namespace {

using testing::Contains;

/// A cluster of Slurm whose jobs never start, of which another call starts or cancels workers.
class ClusterTest : public testing::Test {
 protected:
  Answer answer(const std::vector<std::string>& words) {
    calls_.push_back(words);
    return words.front() == "sinfo" ? Answer{0, sinfo_, ""} : Answer{};
  }
  RunProgram run_ = [this](const auto& words) { return answer(words); };

  Collected start(Start start, std::span<const campaign::TrialPlan* const> plans) {
    Cluster cluster(std::move(start), fake_.folder.root(), FakeCampaign::request, run_);
    return cluster.fly(
        plans, {}, 0, {}, [](const std::string&) {}, [](const campaign::CampaignProgress&) {});
  }

  FakeCampaign fake_;
  std::vector<std::vector<std::string>> calls_;
  std::string sinfo_ = "2/6/0/8";
};

TEST_F(ClusterTest, ALaterCallFindsInTheFolderHowItsWorkersWereStarted) {
  const Start given{{.slurm = true,
                     .slurm_options = {"--partition=fast lane", "--time=1"},
                     .detach = true,
                     .scales_nodes = true},
                    3,
                    "/where/it/was",
                    {{"campaign", "x.toml"}, {"simulator", ""}}};
  EXPECT_EQ(start(given, fake_.wanted()).end, CollectEnd::kLeft);
  const Start found = last_start(fake_.folder.root());
  EXPECT_TRUE(found.options.slurm && found.options.scales_nodes);
  EXPECT_EQ(found.options.slurm_options, given.options.slurm_options);
  EXPECT_EQ(found.jobs, 3);
  EXPECT_EQ(found.working_folder, given.working_folder);
  EXPECT_EQ(found.command, given.command);
}

TEST_F(ClusterTest, CancelsByTheFolderAlone) {
  start({{.slurm = true, .detach = true}, 1, "/", {}}, fake_.wanted());
  cancel_jobs(fake_.folder.root(), run_);
  EXPECT_EQ(calls_.back().front(), "scancel");
  EXPECT_TRUE(fake_.folder.read(newest_round(fake_.folder)->path(kCancelledFile)));
}

TEST_F(ClusterTest, ATaskHasSoManyCoresThatNoSecondTrialFitsBesideIt) {
  const Start detached{{.slurm = true, .detach = true}, 1, "/", {}};
  auto barrier = fake_.wanted();
  std::erase_if(barrier, [](const auto* plan) {
    return plan->condition->policy == scenario::Policy::kFreeRunning;
  });
  start(detached, barrier);
  EXPECT_THAT(calls_.back(), Contains("--cpus-per-task=1"));
  fake_.folder.remove(kWorkersFolder);
  for (auto& condition : fake_.campaign.scenarios[0].scenario.conditions)
    condition.real_time_factor = 1.0;  // in free running, its simulator takes half a core
  start(detached, fake_.wanted());
  EXPECT_THAT(calls_.back(), Contains("--cpus-per-task=2"));
}

TEST_F(ClusterTest, HasATaskForEachCoreThatCanBeUsedUnlessTold) {
  EXPECT_EQ(jobs_of(std::nullopt, {.slurm = true}, run_), 8);
  EXPECT_EQ(jobs_of(5, {.slurm = true}, run_), 5);
  EXPECT_EQ(jobs_of(std::nullopt, {}, run_), 1);
  sinfo_ = "";
  EXPECT_EQ(jobs_of(std::nullopt, {.slurm = true}, run_), 1) << "no answer";
}

TEST_F(ClusterTest, RefusesWhatHasNoEffectOrCannotBe) {
  const auto refused = [](auto&& use) { return thrown_error(ErrorCode::kUsage, use).subject(); };
  const auto require = [&](const ClusterOptions& options) {
    return refused([&] { require_allowed(fake_.campaign, options); });
  };
  EXPECT_EQ(require({.slurm_options = {"--time=1"}}), "--slurm-options");
  EXPECT_EQ(require({.scales_nodes = true}), "--scale-nodes");
  EXPECT_EQ(refused([&] { start({{.slurm = true}, 1001, "/", {}}, fake_.wanted()); }), "--jobs");
  EXPECT_EQ(refused([&] { last_start(fake_.scratch.path("none")); }),
            fake_.scratch.path("none").string());
}

}  // namespace
}  // namespace tether::workers
