#include "fake_cluster.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base_testing/thrown_error.h>

namespace tether::workers {
namespace {

using testing::Contains;
using testing::Not;
using testing::SizeIs;
using testing::StartsWith;

class SlurmTest : public testing::Test {
 protected:
  std::unique_ptr<Engine> make(const std::vector<std::string>& options = {}) {
    return make_slurm({.worker = "tether worker /x",
                       .options = options,
                       .run = [this](const std::vector<std::string>& words) {
                         calls_.push_back(words);
                         const auto answer = answers_.find(words[0]);
                         if (answer == answers_.end()) return Answer{};
                         const Answer next = answer->second.front();
                         if (answer->second.size() > 1) answer->second.pop_front();
                         return next;
                       }});
  }
  FakeCampaign fake_;
  std::optional<Round> round_ = create_round(fake_.folder, 1, {.job = "tether-abc"}, fake_.items());
  std::map<std::string, std::deque<Answer>> answers_;
  std::vector<std::vector<std::string>> calls_;
};

TEST_F(SlurmTest, SubmitsAnArrayUnderTheNameInTheRound) {
  EXPECT_TRUE(make({"--partition=fast"})->start(*round_, {.tasks = 7, .cores = 2}));
  const auto& sbatch = calls_.back();
  for (const char* word : {"--array=1-7", "--job-name=tether-abc", "--cpus-per-task=2",
                           "--no-requeue", "--partition=fast", "--wrap=exec tether worker /x"})
    EXPECT_THAT(sbatch, Contains(word));
  EXPECT_THAT(sbatch, Not(Contains(StartsWith("--exclude"))));
}

TEST_F(SlurmTest, AvoidsNodesOnlyWhileThereAreOthers) {
  answers_["sbatch"] = {{1, "", "node configuration is not available"}, {0, "12\n", ""}};
  EXPECT_TRUE(make()->start(*round_, {.avoid = {"n1", "n2"}}));
  ASSERT_THAT(calls_, SizeIs(3));
  EXPECT_THAT(calls_[1], Contains("--exclude=n1,n2"));
  EXPECT_THAT(calls_[2], Not(Contains(StartsWith("--exclude"))));
}

TEST_F(SlurmTest, KnowsWhichTasksAreAlive) {
  answers_["squeue"] = {
      {0, "12_1|RUNNING|n1|None\n12_2|PENDING||Resources\n12_3|TIMEOUT|n2|x\n", ""}};
  const auto tasks = *make()->tasks(*round_);
  ASSERT_THAT(tasks, SizeIs(3));
  EXPECT_TRUE(tasks[0].is_alive);
  EXPECT_EQ(tasks[0].name, "12_1");
  EXPECT_TRUE(tasks[1].is_alive && tasks[1].is_waiting);
  EXPECT_EQ(tasks[1].state, "Resources");
  EXPECT_FALSE(tasks[2].is_alive);
  EXPECT_EQ(tasks[2].state, "TIMEOUT");
  answers_["squeue"] = {{1, "", "Unable to contact slurm controller"}};
  EXPECT_FALSE(make()->tasks(*round_)) << "no answer is no death";
}

TEST_F(SlurmTest, RefusesWhatCannotWork) {
  EXPECT_EQ(thrown_error(ErrorCode::kUsage, [&] { make({"--array=1-3"}); }).subject(), "--array");
  answers_["sbatch"] = {{1, "", "Invalid account"}};
  EXPECT_EQ(thrown_error(ErrorCode::kSetup, [&] { make()->start(*round_, {}); }).subject(),
            "--slurm");
  answers_["sinfo"] = {{127, "", "sinfo: command not found"}};
  EXPECT_EQ(thrown_error(ErrorCode::kSetup, [&] { make(); }).subject(), "--slurm");
}

TEST_F(SlurmTest, CountsTheCoresThatCanBeUsed) {
  const auto cores_of = [](const Answer& answer) {
    return slurm_cores([&](const auto&) { return answer; });
  };
  EXPECT_EQ(cores_of({0, "10/20/2/32\n", ""}), 30u);
  EXPECT_EQ(cores_of({1, "", "no"}), std::nullopt);
  EXPECT_EQ(cores_of({0, "?", ""}), std::nullopt);
}

}  // namespace
}  // namespace tether::workers
