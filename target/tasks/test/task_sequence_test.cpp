#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <tether/tasks/paper_tasks.h>
#include <tether/tasks/task.h>
#include <tether/tasks/testing/planar_vehicle.h>

namespace tether::tasks {
namespace {

using ::testing::ElementsAre;
using testing::PlanarVehicle;

/// Ends as it is told to, and counts its runs.
class ToldTask : public Task {
 public:
  ToldTask(TaskOutcome outcome, int& runs) : outcome_(std::move(outcome)), runs_(runs) {}
  std::string_view name() const override { return "told"; }
  Progress initialise(TaskContext&) override {
    ++runs_;
    return outcome_;
  }
  Progress step(TaskContext&) override { return outcome_; }
  void finalise(TaskContext&, TaskOutcome& outcome) override { outcome.results["run"] = runs_; }

 private:
  TaskOutcome outcome_;
  int& runs_;
};

struct Told {
  TaskOutcome outcome;
  bool required = true;
};

struct Sequence {
  TaskOutcome run_all(const std::vector<Told>& all) {
    std::vector<SequenceItem> items;
    for (const Told& told : all) {
      items.push_back({std::make_unique<ToldTask>(told.outcome, runs), {}, told.required});
    }
    TaskSequence sequence(std::move(items));
    return run(sequence, context);
  }
  PlanarVehicle vehicle{{}};
  TaskContext context{vehicle};
  int runs = 0;
};

const Failure kGone{Failure::Kind::kDisconnected, "gone"};

TEST(TaskSequence, ReachesItsGoalWithTheLastTask) {
  Sequence f;
  EXPECT_TRUE(f.run_all({}).reached());
  const TaskOutcome outcome =
      f.run_all({{TaskOutcome::goal_reached()}, {TaskOutcome::goal_reached()}});
  EXPECT_TRUE(outcome.reached());
  EXPECT_EQ(outcome.reason, "goal reached");
  EXPECT_EQ(outcome.results.at("tasks_run"), 2);
  EXPECT_EQ(outcome.results.at("tasks_reached"), 2);
  ASSERT_EQ(outcome.parts.size(), 2u);
  EXPECT_EQ(outcome.parts[1].task, "told");
  EXPECT_EQ(outcome.parts[1].results.at("run"), 2);
}

TEST(TaskSequence, EndsWithARequiredTaskThatDoesNotReachItsGoal) {
  Sequence f;
  const TaskOutcome outcome = f.run_all({{TaskOutcome::goal_reached()},
                                         {TaskOutcome::not_reached("anchor lost")},
                                         {TaskOutcome::goal_reached()}});
  EXPECT_EQ(outcome.status, TaskStatus::kNotReached);
  EXPECT_EQ(outcome.reason, "task 2 (told): anchor lost");
  EXPECT_EQ(f.runs, 2);
  EXPECT_EQ(outcome.results.at("tasks_reached"), 1);
}

TEST(TaskSequence, GoesOnAfterOneThatIsNotRequired) {
  Sequence f;
  const TaskOutcome outcome =
      f.run_all({{TaskOutcome::not_reached("anchor lost"), false}, {TaskOutcome::goal_reached()}});
  EXPECT_TRUE(outcome.reached());
  EXPECT_EQ(outcome.results.at("tasks_run"), 2);
  EXPECT_EQ(outcome.results.at("tasks_reached"), 1);
  EXPECT_EQ(outcome.parts[0].reason, "anchor lost");
}

/// Ends as listed, one run after the other; each takes a second.
class ListedTask : public Task {
 public:
  explicit ListedTask(std::vector<TaskOutcome> outcomes) : outcomes_(std::move(outcomes)) {}
  std::string_view name() const override { return "listed"; }
  Progress initialise(TaskContext& context) override {
    EXPECT_TRUE(context.vehicle().sleep_for(std::chrono::seconds(1)));
    return outcomes_[std::min(runs_++, outcomes_.size() - 1)];
  }
  Progress step(TaskContext&) override { return std::nullopt; }
  void finalise(TaskContext&, TaskOutcome&) override {}

 private:
  std::vector<TaskOutcome> outcomes_;
  std::size_t runs_ = 0;
};

const TaskOutcome kReached = TaskOutcome::goal_reached();
const TaskOutcome kLost = TaskOutcome::not_reached("lost");

struct Ordered {
  std::vector<TaskOutcome> outcomes;
  SequenceItem order = {};
};

TaskOutcome run_in_order(std::vector<Ordered> all, std::vector<std::string>* notes = nullptr) {
  PlanarVehicle vehicle{{}};
  TaskContext context{vehicle};
  std::vector<SequenceItem> items;
  for (Ordered& one : all) {
    one.order.task = std::make_unique<ListedTask>(one.outcomes);
    items.push_back(std::move(one.order));
  }
  TaskSequence sequence(std::move(items));
  const TaskOutcome outcome = run(sequence, context);
  for (const auto& note : vehicle.annotations())
    if (notes && note.topic == "mission") notes->push_back(note.json);
  return outcome;
}

template <class... Ordereds>
std::vector<Ordered> in_order(Ordereds... all) {
  std::vector<Ordered> items;
  (items.push_back(std::move(all)), ...);
  return items;
}

TEST(TaskSequence, RepeatsATaskUntilItReachesItsGoal) {
  std::vector<std::string> notes;
  const TaskOutcome reached =
      run_in_order(in_order(Ordered{{kLost, kReached}, {.name = "find", .retry = 3}}), &notes);
  EXPECT_TRUE(reached.reached());
  EXPECT_EQ(reached.results.at("tasks_run"), 2);
  EXPECT_THAT(
      notes,
      ElementsAre(R"({"event":"start","task":"find"})",
                  R"({"event":"end","reason":"lost","status":"not_reached","task":"find"})",
                  R"({"event":"start","task":"find"})",
                  R"({"event":"end","reason":"goal reached","status":"reached","task":"find"})"));
  const TaskOutcome missed = run_in_order(in_order(Ordered{{kLost}, {.retry = 2}}));
  EXPECT_EQ(missed.results.at("tasks_run"), 3);
  EXPECT_EQ(missed.reason, "task 1 (listed): lost");
}

TEST(TaskSequence, GoesOnElsewhereAfterAMiss) {
  const TaskOutcome outcome = run_in_order(
      in_order(Ordered{{kLost}, {.otherwise = 2}}, Ordered{{kReached}}, Ordered{{kReached}}));
  EXPECT_EQ(outcome.status, TaskStatus::kNotReached);
  EXPECT_EQ(outcome.reason, "task 1 (listed): lost");
  EXPECT_EQ(outcome.results.at("tasks_run"), 2);
}

TEST(TaskSequence, AGoalThatIsReachedTooLateIsMissed) {
  const Duration half = std::chrono::milliseconds(500), two = std::chrono::seconds(2);
  EXPECT_EQ(run_in_order(in_order(Ordered{{kReached}, {.within = half}})).reason,
            "task 1 (listed): 0.500 s late");
  EXPECT_TRUE(
      run_in_order(in_order(Ordered{{kReached}, {.within = two, .before = two}})).reached());
  const TaskOutcome third = run_in_order(
      in_order(Ordered{{kReached}}, Ordered{{kReached}}, Ordered{{kReached}, {.before = two}}));
  EXPECT_EQ(third.reason, "task 3 (listed): 1.000 s late");
}

TEST(TaskSequence, AFailureEndsItRequiredOrNot) {
  for (const bool required : {true, false}) {
    Sequence f;
    const TaskOutcome outcome =
        f.run_all({{TaskOutcome::failed(kGone), required}, {TaskOutcome::goal_reached()}});
    EXPECT_EQ(outcome.status, TaskStatus::kFailed);
    EXPECT_EQ(outcome.failure, Failure::Kind::kDisconnected);
    EXPECT_EQ(outcome.reason, "task 1 (told): gone");
    EXPECT_EQ(f.runs, 1);
  }
}

TEST(TaskSequence, ComposesTasksWithTheirOwnVisionOptions) {
  Sequence f;
  FaceAnchorOptions face;
  face.convergence.tolerance_px = 2.0;
  const RelativePositionOptions look{.convergence = face.convergence};
  VisionOptions blind;
  blind.tracker.min_score = 1.0;
  std::vector<SequenceItem> items;
  items.push_back({std::make_unique<RelativePositionTask>("blue_box", look), blind, false});
  items.push_back({std::make_unique<FaceAnchorTask>("blue_box", face), {}, true});
  items.push_back({std::make_unique<RelativePositionTask>("blue_box", look), {}, true});
  TaskSequence sequence(std::move(items));
  const TaskOutcome outcome = run(sequence, f.context);
  EXPECT_TRUE(outcome.reached()) << outcome.reason;

  const auto details = nlohmann::json::parse(details_json(outcome));
  std::vector<std::string> ends;
  for (const auto& part : details.at("tasks")) {
    ends.push_back(part.at("task").get<std::string>() + ": " +
                   part.at("reason").get<std::string>());
  }
  EXPECT_THAT(ends, ElementsAre("relative_position: anchor not seen", "face_anchor: goal reached",
                                "relative_position: goal reached"));
  EXPECT_LT(std::abs(details.at("tasks").at(2).at("results").at("bearing_rad").get<double>()),
            0.06);
  EXPECT_EQ(details.at("results").at("tasks_run"), 3);
}

}  // namespace
}  // namespace tether::tasks
