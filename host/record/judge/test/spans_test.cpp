#include "spans.h"

#include "flight.h"

#include <gmock/gmock.h>

namespace tether::judge {
namespace {

using ::testing::ElementsAre;

mission::Mission mission_of(const std::vector<std::string>& names) {
  mission::Mission mission;
  for (const std::string& name : names) mission.tasks.emplace_back().name = name;
  return mission;
}
const mission::Mission kMission = mission_of({"a", "b"});

TEST(Spans, JoinTheRepetitionsOfATask) {
  Flight flight;
  flight.task("a", 1, 2, "not_reached").task("a", 2, 4).note(5, R"({"task":"b","event":"start"})");
  flight.note(6, "[]").note(6, R"({"task":7,"event":"start"})").note(6, R"({"event":"end"})");
  flight.note(6, R"({"task":"of nobody","event":"start"})");
  EXPECT_THAT(task_spans(kMission, "uav1", flight.record()),
              ElementsAre(TaskSpan{"uav1", "a", st(1), st(4), "reached", "so"},
                          TaskSpan{"uav1", "b", st(5), st(10), "unfinished", ""}));
  EXPECT_THAT(task_spans(kMission, "uav2", flight.record()), ElementsAre());
}

TEST(Spans, HaveNoControlCharacters) {
  Flight flight;
  flight.note(1, R"({"task":"a","event":"start"})");
  flight.note(2, R"({"task":"a","event":"end","status":"\u001b[2J","reason":"x\ny"})");
  const TaskSpan span = task_spans(kMission, "uav1", flight.record()).at(0);
  EXPECT_EQ(span.status, "?[2J");
  EXPECT_EQ(span.reason, "x?y");
}

TEST(Spans, AreInStInFreeRunning) {
  Flight flight;
  flight.task("a", 1, 2);
  flight.record().header.policy = record::kFreeRunning;
  for (auto& logged : flight.record().annotations) logged.message.at += std::chrono::hours(1);
  EXPECT_EQ(task_spans(kMission, "uav1", flight.record()).at(0).to, st(2));
}

TEST(Spans, TheMissionEndsWithItsFinish) {
  Flight flight;
  EXPECT_EQ(mission_span("uav1", flight.record()).to, st(10));
  flight.finish(7);
  EXPECT_EQ(mission_span("uav1", flight.record()).to, st(7));
}

TEST(Spans, TellWhatTookTheTime) {
  Flight flight;
  flight.image(1, 1.5, 1.2).command(3, 3).image(3, 4, 3).finish(5);
  EXPECT_EQ(time_taken("uav1", {st(0), st(5)}, flight.record()),
            "computing 3.5 s, waiting for eye 1.5 s");
  EXPECT_EQ(time_taken("uav1", {st(3.5), st(4.25)}, flight.record()),
            "waiting for eye 0.5 s, computing 0.25 s");
  flight.record().header.suts[0].concurrent = true;
  EXPECT_EQ(time_taken("uav1", {st(0), st(5)}, flight.record()), "");
}

}  // namespace
}  // namespace tether::judge
