#include "shards_fixture.h"

#include <chrono>

#include <gmock/gmock.h>

#include <tether/base_testing/thrown_error.h>
#include <tether/os/text_file.h>
#include <tether/shards/engine_flights.h>

namespace tether::shards {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// An engine whose shards copy the results of flights that are prepared in a folder.
class EngineFlights : public ShardsTest {
 protected:
  EngineFlights() {
    for (auto& condition : campaign_.scenarios[0].scenario.conditions)
      condition.policy = scenario::Policy::kConservativeBarrier;
    fs::create_directory(out());
    plans_ = plans(out());
    for (const campaign::TrialPlan& plan : plans_) {
      wanted_.push_back(&plan);
      const fs::path prepared = scratch_.path("prepared") / plan.folder.lexically_relative(out());
      fs::create_directories(prepared.parent_path());
      fs::rename(flown(plan), prepared);
    }
    setup_.engine = {.file = "engine.toml",
                     .command = {"sh", "-c", "for i in $(seq {shards}); do {script} $i; done"}};
    setup_.shards = 2;
    setup_.campaign = out();
    setup_.request = [this](const campaign::TrialPlan& plan) {
      return plan.folder.lexically_relative(out()).string();
    };
    setup_.tell = [this](const std::string& line) { told_ += line + "\n"; };
    setup_.look_period = std::chrono::milliseconds(5);
    write_shard("");
    setup_.shard_command = "sh " + shard_.string();
  }
  /// The program of a shard: `guard` may end it, or skip a trial, "$t". Its number is in $k.
  void write_shard(const std::string& guard) {
    shard_ = scratch_.write("shard", "out='" + out().string() + "' prepared='" +
                                         scratch_.path("prepared").string() + "'\n" + R"sh(set -e
k=${1##*-} i=0
k=${k%.json}
for t in $(sed -n 's/.*"request": "\(.*\)".*/\1/p' "$1"); do
  i=$((i + 1))
)sh" + guard + R"sh(
  mkdir -p "$out/${t%/*}"
  cp -r "$prepared/$t" "$out/$t"
done
)sh");
  }
  campaign::CampaignOutcome fly(const std::stop_token& stop = {}) {
    return fly_by_engine(setup_, wanted_, 4, stop,
                         [this](const campaign::CampaignProgress& now) { last_ = now; });
  }
  std::size_t results() const {
    return static_cast<std::size_t>(std::ranges::count_if(
        plans_, [](const auto& one) { return campaign::has_result(one.folder); }));
  }

  std::vector<campaign::TrialPlan> plans_;
  std::vector<const campaign::TrialPlan*> wanted_;
  EngineSetup setup_;
  fs::path shard_;
  std::string told_;
  campaign::CampaignProgress last_;
};

TEST_F(EngineFlights, BringAllResults) {
  const auto outcome = fly();
  EXPECT_EQ(outcome.ran, 9u);
  EXPECT_EQ(outcome.failed, 0u);
  EXPECT_FALSE(outcome.interrupted);
  EXPECT_EQ(results(), 9u);
  EXPECT_EQ(last_.done, 13u);
  EXPECT_EQ(last_.total, 13u);
  EXPECT_EQ(told_, "");
}

TEST_F(EngineFlights, FlyAgainWhatKilledShardsLeft) {
  const auto once = scratch_.path("was-killed").string();
  write_shard("if [ $i -ge 3 ] && mkdir '" + once + "-'$k 2> /dev/null; then kill -9 $$; fi");
  EXPECT_EQ(fly().ran, 9u);
  EXPECT_EQ(results(), 9u);
  EXPECT_THAT(told_, HasSubstr("without a result: flying again"));
}

TEST_F(EngineFlights, EndWhereACallBringsNothingAndSayWhy) {
  write_shard("case \"$t\" in *0003) echo 'no such node' >&2; exit 1;; esac");
  const Error error = thrown_error(ErrorCode::kSetup, [&] { fly(); });
  EXPECT_THAT(error.what(), HasSubstr("of 13 trials have no result, because their shards ended "
                                      "(shard-1.log: no such node). Correct that"));
  EXPECT_GT(results(), 0u);
  EXPECT_LT(results(), 9u);
}

TEST_F(EngineFlights, ReportTheEngineThatCannotBeStarted) {
  setup_.engine.command = {"sh", "-c", "echo 'sbatch: error: invalid partition' >&2; exit 1"};
  EXPECT_THAT(thrown_error(ErrorCode::kSetup, [&] { fly(); }).what(),
              HasSubstr("engine.log: sbatch: error: invalid partition"));
  setup_.engine.command = {"/nowhere/sbatch"};
  EXPECT_THAT(thrown_error(ErrorCode::kSetup, [&] { fly(); }).what(), HasSubstr("/nowhere/sbatch"));
}

TEST_F(EngineFlights, CancelTheirShardsAfterAStopRequest) {
  const fs::path cancelled = scratch_.path("cancelled");
  setup_.engine.command = {"sleep", "600"};
  setup_.engine.cancel = {"sh", "-c", "echo {name} > " + cancelled.string()};
  std::stop_source stop;
  stop.request_stop();
  EXPECT_TRUE(fly(stop.get_token()).interrupted);
  EXPECT_THAT(os::read_file(cancelled), testing::StartsWith("tether-"));
}

TEST_F(EngineFlights, KeepFailedSetUpsAsFailed) {
  const auto first = wanted_.front();
  fs::remove_all(scratch_.path("prepared") / first->folder.lexically_relative(out()));
  fs::rename(flown(*first, 4.0, std::string(campaign::kEndSetupFailed)),
             scratch_.path("prepared") / first->folder.lexically_relative(out()));
  write_shard("rm -rf '" + out().string() + "'/\"$t\"");
  const auto outcome = fly();
  EXPECT_EQ(outcome.ran, 8u);
  EXPECT_EQ(outcome.failed, 1u);
}

// A trial in free running takes half a core for its simulator.
TEST_F(EngineFlights, NeedCoresThatTheEngineGives) {
  for (auto& condition : campaign_.scenarios[0].scenario.conditions) {
    condition.policy = scenario::Policy::kFreeRunning;
    condition.real_time_factor = 1.0;
  }
  EXPECT_EQ(thrown_error(ErrorCode::kUsage, [&] { fly(); }).subject(), "--engine");
  setup_.engine.command.back() += " # {cores}";
  EXPECT_EQ(fly().ran, 9u);
}

}  // namespace
}  // namespace tether::shards
