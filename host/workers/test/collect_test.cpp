#include "fake_cluster.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base_testing/thrown_error.h>

namespace tether::workers {
namespace {

using campaign::read_result;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

/// An engine whose workers run when the collector looks, one round after the other as scripted.
class ScriptedEngine final : public Engine {
 public:
  using Act = std::function<void(const Round&)>;
  std::deque<Act> rounds;
  std::vector<Order> orders;
  std::vector<Task> ended;  ///< the tasks once they have run
  int cancelled = 0;

  bool start(const Round& round, const Order& order) override {
    if (rounds.empty()) return false;
    orders.push_back(order);
    running_ = round.number();
    return true;
  }
  std::optional<std::vector<Task>> tasks(const Round& round) override {
    if (running_ != round.number()) return std::vector<Task>{};
    if (!rounds.empty() && acted_ != round.number()) {
      acted_ = round.number();
      rounds.front()(round);
      rounds.pop_front();
    }
    return ended;
  }
  void cancel(const Round&) override { ++cancelled; }

 private:
  std::size_t running_ = 0, acted_ = 0;
};

class Collect : public testing::Test {
 protected:
  Collected run() {
    return collect(fake_.folder, fake_.wanted(), engine_,
                   {.settings = {},
                    .order = {.tasks = 2},
                    .request = FakeCampaign::request,
                    .stop = stop_.get_token(),
                    .detaches = detaches_,
                    .now = [this] { return now_; },
                    .sleep = [this](Duration pause) { now_ += pause; },
                    .tell = [this](const std::string& line) { told_.push_back(line); }});
  }
  ScriptedEngine::Act fly(const std::string& node = "n1") {
    return [this, node](const Round& round) { work(round, worker(node)); };
  }
  /// A worker that is killed in its `index`-th flight.
  ScriptedEngine::Act vanish(std::size_t index, const std::string& node) {
    return [this, index, node](const Round& round) {
      WorkerSetup setup = worker(node);
      const std::size_t begin = fake_.flown.size();
      setup.fly = [this, index, begin, own = setup.fly](const Item& item, const auto& local,
                                                        double scale) {
        if (fake_.flown.size() == begin + index) throw Killed{};
        return own(item, local, scale);
      };
      try {
        work(round, setup);
      } catch (const Killed&) {
      }
    };
  }
  WorkerSetup worker(const std::string& node) {
    return fake_.worker("w" + std::to_string(++workers_), node);
  }
  struct Killed {};

  FakeCampaign fake_;
  ScriptedEngine engine_;
  std::stop_source stop_;
  bool detaches_ = false;
  Duration now_{0};
  int workers_ = 0;
  std::vector<std::string> told_;
};

TEST_F(Collect, EndsWhenEachTrialHasAResult) {
  engine_.rounds = {fly()};
  const Collected collected = run();
  EXPECT_EQ(collected.end, CollectEnd::kComplete);
  EXPECT_EQ(collected.outcome.ran, 9u);
  EXPECT_TRUE(collected.losses.empty());
  EXPECT_THAT(engine_.orders, SizeIs(1));
  EXPECT_EQ(fake_.results(), 9u);
}

TEST_F(Collect, FliesWhatAVanishedWorkerHadInHandAgainElsewhere) {
  engine_.ended = {{.name = "7_w1", .is_alive = false, .state = "NODE_FAIL", .node = "n1"}};
  engine_.rounds = {vanish(4, "n1"), fly("n2")};
  const Collected collected = run();
  EXPECT_EQ(collected.end, CollectEnd::kComplete);
  EXPECT_EQ(fake_.results(), 9u);
  ASSERT_THAT(collected.losses, SizeIs(1));
  EXPECT_THAT(collected.losses[0], HasSubstr("NODE_FAIL"));
  EXPECT_EQ(told_, collected.losses);
  EXPECT_THAT(engine_.orders[1].avoid, ElementsAre("n1"));
}

TEST_F(Collect, DoesNotCountTrialsAsLostThatWereNotBegun) {
  engine_.rounds = {[&](const Round& round) {
                      std::stop_source stopped;
                      stopped.request_stop();
                      WorkerSetup setup = worker("n1");
                      setup.stop = stopped.get_token();
                      work(round, setup);
                    },
                    fly()};
  EXPECT_TRUE(run().losses.empty());
  EXPECT_EQ(fake_.results(), 9u);
}

TEST_F(Collect, ReportsATrialThatWasLostThreeTimesAsNotFlown) {
  const auto lose_one = [&](const Round& round) {
    WorkerSetup setup = worker("n" + std::to_string(workers_));
    setup.fly = [own = setup.fly](const Item& item, const auto& local, double scale) {
      if (item.folder == "turn/target/seed-0002") return Flight{Flight::End::kLost, "no memory"};
      return own(item, local, scale);
    };
    work(round, setup);
  };
  engine_.rounds = {lose_one, lose_one, lose_one};
  const Collected collected = run();
  EXPECT_EQ(collected.end, CollectEnd::kComplete);
  EXPECT_EQ(collected.outcome.failed, 1u);
  const auto result = read_result(fake_.folder.root() / "turn/target/seed-0002");
  EXPECT_EQ(result.end, campaign::kEndSetupFailed);
  EXPECT_EQ(result.this_run.attempts, 3);
  EXPECT_THAT(result.reason, HasSubstr("n2: no memory"));
}

TEST_F(Collect, GivesUpWhereNothingFlies) {
  const auto nothing = [&](const Round& round) {
    round.folder().create(round.path("workers/x"), "");
  };
  engine_.rounds = {nothing, nothing, nothing, nothing};
  thrown_error(ErrorCode::kSetup, [&] { run(); });
  EXPECT_THAT(engine_.orders, SizeIs(kMostBarrenRounds));
}

TEST_F(Collect, GoesOnWithTheRoundOfAnEarlierCall) {
  detaches_ = true;
  engine_.rounds = {fly()};
  EXPECT_EQ(run().end, CollectEnd::kLeft);
  EXPECT_EQ(fake_.results(), 0u);
  detaches_ = false;
  EXPECT_EQ(run().end, CollectEnd::kComplete);
  EXPECT_THAT(engine_.orders, SizeIs(1));
}

// The round was made, but its submission did not happen.
TEST_F(Collect, SubmitsARoundThatNobodySubmitted) {
  create_round(fake_.folder, 1, {.job = "early"}, fake_.items());
  engine_.rounds = {fly()};
  EXPECT_EQ(run().end, CollectEnd::kComplete);
  EXPECT_THAT(engine_.orders, SizeIs(1));
  EXPECT_EQ(newest_round(fake_.folder)->number(), 1u);
}

TEST_F(Collect, StopsAndLeavesTheRound) {
  engine_.ended = {{.name = "7_1", .is_alive = true}};
  engine_.rounds = {[&](const Round&) { stop_.request_stop(); }};
  EXPECT_EQ(run().end, CollectEnd::kLeft);
  EXPECT_EQ(engine_.cancelled, 0);
}

// Whoever collects must not submit again what another process cancelled.
TEST_F(Collect, EndsWhenTheJobsAreCancelledAndGoesOnLater) {
  engine_.rounds = {[&](const Round& round) {
                      vanish(2, "n1")(round);
                      cancel(round, engine_);
                    },
                    fly()};
  EXPECT_EQ(run().end, CollectEnd::kCancelled);
  EXPECT_EQ(engine_.cancelled, 1);
  EXPECT_THAT(engine_.orders, SizeIs(1));
  const Collected later = run();
  EXPECT_EQ(later.end, CollectEnd::kComplete);
  EXPECT_TRUE(later.losses.empty()) << "no machine failed";
  EXPECT_EQ(fake_.results(), 9u);
}

TEST_F(Collect, NeedsWorkersWhereNobodyStartsThem) {
  EXPECT_EQ(run().end, CollectEnd::kNeedsWorkers);
  work(*newest_round(fake_.folder), worker("n1"));
  EXPECT_EQ(run().end, CollectEnd::kComplete);
}

TEST_F(Collect, NoticesTasksThatNeverReachTheFolder) {
  engine_.ended = {{.name = "7_1", .is_alive = false, .state = "FAILED", .node = "n1"},
                   {.name = "7_2", .is_alive = true, .state = "RUNNING", .node = "n2"}};
  engine_.rounds = {[](const Round&) {}, fly()};
  const Error error = thrown_error(ErrorCode::kSetup, [&] { run(); });
  EXPECT_EQ(error.subject(), fake_.folder.root().string());
  EXPECT_EQ(engine_.cancelled, 1);
  engine_.ended.clear();
  EXPECT_EQ(run().end, CollectEnd::kComplete) << "nothing is lost";
}

TEST_F(Collect, TwoCollectorsGetOneResultForEachTrial) {
  ScriptedEngine other;
  Collected second;
  engine_.rounds = {[&](const Round& round) {
    vanish(5, "n1")(round);
    other.rounds = {fly("n2")};  // the other collector finds the round over, and makes the next
    second = collect(fake_.folder, fake_.wanted(), other,
                     {.settings = {},
                      .order = {.tasks = 2},
                      .request = FakeCampaign::request,
                      .now = [this] { return now_; },
                      .sleep = [this](Duration pause) { now_ += pause; }});
  }};
  EXPECT_EQ(run().end, CollectEnd::kComplete);
  EXPECT_EQ(second.end, CollectEnd::kComplete);
  EXPECT_EQ(fake_.results(), 9u);
}

TEST_F(Collect, ReplacesWhatIsLeftOfTrialsThatWereNotFlown) {
  fake_.scratch.write("out/turn/host/seed-0001/record.mcap", "cut short");
  auto failed = campaign::make_setup_failure(*fake_.plans[1].scenario, *fake_.plans[1].condition,
                                             fake_.plans[1].seed, "not flown");
  std::filesystem::create_directories(fake_.plans[1].folder);
  campaign::write_result(fake_.plans[1].folder, failed);
  engine_.rounds = {fly()};
  EXPECT_EQ(run().outcome.ran, 9u);
  EXPECT_THAT(fake_.flown, SizeIs(9));
}

}  // namespace
}  // namespace tether::workers
