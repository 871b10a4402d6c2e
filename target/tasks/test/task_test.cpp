#include <cmath>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <tether/tasks/task.h>
#include <tether/tasks/testing/planar_vehicle.h>

namespace tether::tasks {
namespace {

using ::testing::ElementsAre;

/// Writes down its phases; ends in `end_in`, after three rounds if that is the loop.
class DiaryTask : public Task {
 public:
  DiaryTask(std::vector<std::string>& diary, std::string end_in, Task* inner = nullptr)
      : diary_(diary), end_in_(std::move(end_in)), inner_(inner) {}

  std::string_view name() const override { return inner_ ? "outer" : "inner"; }
  Progress initialise(TaskContext& context) override { return write("initialise", context); }
  Progress step(TaskContext& context) override {
    return ++rounds_ < 3 ? std::nullopt : write("step", context);
  }
  void finalise(TaskContext& context, TaskOutcome& outcome) override {
    write("finalise", context);
    outcome.results["rounds"] = rounds_;
  }

 private:
  Progress write(const std::string& phase, TaskContext& context) {
    diary_.push_back(std::string(name()) + " " + phase);
    if (inner_ != nullptr) run(*inner_, context);
    return phase == end_in_ ? Progress(TaskOutcome::not_reached("tired")) : std::nullopt;
  }

  std::vector<std::string>& diary_;
  std::string end_in_;
  Task* inner_;
  int rounds_ = 0;
};

struct Fixture {
  testing::PlanarVehicle vehicle{{}};
  TaskContext context{vehicle};
  std::vector<std::string> diary;
};

TEST(Run, ATaskMayRunAnotherInAnyPhase) {
  Fixture f;
  DiaryTask inner(f.diary, "initialise");
  DiaryTask outer(f.diary, "step", &inner);
  run(outer, f.context);
  EXPECT_THAT(f.diary, ElementsAre("outer initialise", "inner initialise", "inner finalise",
                                   "outer step", "inner initialise", "inner finalise",
                                   "outer finalise", "inner initialise", "inner finalise"));
}

TEST(Run, CallsThePhasesInOrderAndNotesThem) {
  Fixture f;
  DiaryTask task(f.diary, "step");
  const TaskOutcome outcome = run(task, f.context);
  EXPECT_THAT(f.diary, ElementsAre("inner initialise", "inner step", "inner finalise"));
  EXPECT_EQ(outcome.status, TaskStatus::kNotReached);
  EXPECT_EQ(outcome.reason, "tired");
  EXPECT_EQ(outcome.results.at("rounds"), 3);
  std::vector<std::string> notes;
  for (const auto& annotation : f.vehicle.annotations()) {
    EXPECT_EQ(annotation.topic, "task");
    const auto note = nlohmann::json::parse(annotation.json);
    EXPECT_EQ(note.at("task"), "inner");
    notes.push_back(note.at("phase").get<std::string>() + " " +
                    note.at("event").get<std::string>());
  }
  EXPECT_THAT(notes,
              ElementsAre("initialise start", "loop start", "finalise start", "finalise end"));
}

TEST(TaskOutcome, DetailsAreJson) {
  TaskOutcome outcome = TaskOutcome::not_reached("said \"no\"\n");
  outcome.results["angle_rad"] = 0.5;
  outcome.results["distance_m"] = std::nan("");
  const auto details = nlohmann::json::parse(details_json(outcome));
  EXPECT_EQ(details.at("status"), "not_reached");
  EXPECT_EQ(details.at("reason"), "said \"no\"\n");
  EXPECT_EQ(details.at("results").at("angle_rad"), 0.5);
  EXPECT_TRUE(details.at("results").at("distance_m").is_null());
}

TEST(TaskOutcome, NamesItsStatusAndKeepsAFailuresKind) {
  const TaskOutcome outcome = TaskOutcome::failed({Failure::Kind::kTimeout, "no answer"});
  EXPECT_EQ(outcome.failure, Failure::Kind::kTimeout);
  EXPECT_EQ(outcome.reason, "no answer");
  EXPECT_EQ(name(outcome.status), "failed");
  EXPECT_EQ(name(TaskStatus::kReached), "reached");
  EXPECT_EQ(name(TaskStatus::kNotReached), "not_reached");
}

}  // namespace
}  // namespace tether::tasks
