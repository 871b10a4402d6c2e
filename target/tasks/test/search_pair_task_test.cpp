#include "flight.h"

#include <deque>
#include <string>

#include <gmock/gmock.h>

#include <tether/tasks/mission_tasks.h>

namespace tether::tasks {
namespace {

using std::chrono::seconds;

/// With a radio on which the other UAV says what the test wants, from an instant on.
class TalkingVehicle : public testing::PlanarVehicle {
 public:
  using PlanarVehicle::PlanarVehicle;
  Status send(std::string_view, std::span<const std::uint8_t> bytes) override {
    sent.emplace_back(bytes.begin(), bytes.end());
    return ok_status();
  }
  Result<client::RadioMessage> receive(Duration timeout) override {
    const bool is_time = !others.empty() && now() + timeout >= from;
    if (timeout > Duration(0)) static_cast<void>(sleep_for(timeout));
    if (!is_time) return Failure{Failure::Kind::kNothingYet, ""};
    const std::string text = others.front();
    others.pop_front();
    return client::RadioMessage{"other", {}, {}, {text.begin(), text.end()}};
  }

  std::deque<std::string> others;
  ExecTime from;
  std::vector<std::string> sent;
};

struct PairFlight {
  explicit PairFlight(const testing::PlanarVehicle::Options& world) : vehicle(world) {}
  TaskOutcome fly(const SearchPairOptions& options = {}) {
    SearchPairTask task("blue_box", options);
    TaskContext context(vehicle);
    return run(task, context);
  }
  TalkingVehicle vehicle;
};

TEST(SearchPairTask, TheOneThatFindsTheAnchorCallsUntilTheOtherIsThere) {
  PairFlight pair({.anchor_bearing_rad = 1.0});
  pair.vehicle.others = {"noise", "here"};
  pair.vehicle.from = ExecTime(seconds(8));
  const TaskOutcome outcome = pair.fly();
  ASSERT_TRUE(outcome.reached()) << outcome.reason;
  EXPECT_EQ(outcome.results.at("found"), 1.0);
  EXPECT_GT(pair.vehicle.sent.size(), 3U);
  EXPECT_THAT(pair.vehicle.sent, ::testing::Each("found"));
  EXPECT_LT(norm(pair.vehicle.position()), 0.1) << "it stays where it is";
}

TEST(SearchPairTask, TheOtherOneComes) {
  PairFlight pair({.anchor_is_there = false, .start_yaw_rad = 0.5});
  pair.vehicle.others = {"found"};
  pair.vehicle.from = ExecTime(seconds(3));
  const TaskOutcome outcome =
      pair.fly({.partner_ahead_m = 3.0, .partner_left_m = 4.0, .gap_m = 1.0});
  ASSERT_TRUE(outcome.reached()) << outcome.reason;
  EXPECT_EQ(outcome.results.at("found"), 0.0);
  EXPECT_THAT(pair.vehicle.sent, ::testing::Each("here"));
  const double direction_rad = 0.5 + std::atan2(4.0, 3.0);
  EXPECT_NEAR(pair.vehicle.position().x, 4.0 * std::cos(direction_rad), 0.4);
  EXPECT_NEAR(pair.vehicle.position().y, 4.0 * std::sin(direction_rad), 0.4);
}

TEST(SearchPairTask, WithoutAnAnswerItMissesItsGoal) {
  PairFlight pair({.anchor_bearing_rad = 1.0});
  const TaskOutcome outcome = pair.fly({.search = {.time_limit = seconds(6)}});
  EXPECT_EQ(outcome.status, TaskStatus::kNotReached);
  EXPECT_EQ(outcome.reason, "time limit");
  EXPECT_EQ(outcome.results.at("found"), 1.0);
}

}  // namespace
}  // namespace tether::tasks
