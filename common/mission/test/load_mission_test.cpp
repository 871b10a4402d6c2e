#include "mission_text.h"

#include <chrono>
#include <filesystem>

#include <gmock/gmock.h>

namespace tether::mission {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::Field;
using Kind = Clause::Kind;

TEST(Mission, HasTasksAndClauses) {
  const Mission mission = parsed(R"(
anchor = "blue_box"
[[task]]
task = "search"
within_s = 8
on_miss = "land"
retry = 2
[[task]]
task = "search"
required = false
before_s = 20
[[task]]
task = "land"
speed_m_s = 0.3
[[clause]]
always = "clearance >= 0.3 m"
[[clause]]
name = "sees it"
during = ["search", "search_2"]
eventually = "bearing_error <= 5 deg"
for_s = 1.5
within_s = 4
[[clause]]
after = "search_2"
never = "speed >= 1 m/s"
[[clause]]
during = ["land"]
before_s = 50
)");
  ASSERT_THAT(mission.tasks,
              ElementsAre(Field(&Task::name, "search"), Field(&Task::name, "search_2"),
                          Field(&Task::name, "land")));
  EXPECT_EQ(mission.tasks[0].on_miss, (OnMiss{OnMiss::Kind::kGoTo, 2}));
  EXPECT_EQ(mission.tasks[0].retry, 2);
  EXPECT_EQ(mission.tasks[0].within, 8s);
  EXPECT_EQ(mission.tasks[1].on_miss.kind, OnMiss::Kind::kContinue);
  EXPECT_EQ(mission.tasks[2].on_miss.kind, OnMiss::Kind::kAbort);
  ASSERT_THAT(mission.clauses,
              ElementsAre(Field(&Clause::name, "search within 8 s"),
                          Field(&Clause::name, "search_2 before 20 s"),
                          Field(&Clause::name, "mission: always clearance >= 0.3 m"),
                          Field(&Clause::name, "sees it"),
                          Field(&Clause::name, "after search_2: never speed >= 1 m/s"),
                          Field(&Clause::name, "land before 50 s")));
  EXPECT_EQ(mission.clauses[0].where, (FileLocation{"m.toml", 5}));
  const Clause& sees = mission.clauses[3];
  EXPECT_EQ(sees.kind, Kind::kEventually);
  EXPECT_EQ(sees.during, (std::pair<std::size_t, std::size_t>{0, 1}));
  EXPECT_EQ(sees.condition->of, "blue_box");
  EXPECT_EQ(sees.hold, 1500ms);
  EXPECT_EQ(sees.within, 4s);
  EXPECT_EQ(mission.clauses[4].after, 1u);
  EXPECT_EQ(mission.clauses[5].before, 50s);
}

TEST(Mission, RefusesTasksThatCannotBe) {
  const std::string search = "[[task]]\ntask = \"search\"\n", land = "[[task]]\ntask = \"land\"\n";
  struct Case {
    std::string text;
    int line;
    const char* subject;
  };
  for (const Case& c :
       std::vector<Case>{{"anchor = \"b\"", 1, ""},
                         {search + land + "name = \"search\"", 5, "name"},
                         {search + "name = \"abort\"", 3, "name"},
                         {search + "on_miss = \"fly\"\n" + land, 3, "on_miss"},
                         {search + "name = \"a\"\n" + land + "on_miss = \"a\"", 6, "on_miss"},
                         {search + "on_miss = \"search\"", 3, "on_miss"},
                         {search + "required = true\non_miss = \"continue\"", 3, "required"},
                         {search + "retry = -1", 3, "retry"},
                         {search + "withn_s = 8", 3, "withn_s"},
                         {search + "within_ms = 8", 3, "within_ms"},
                         {search + "before = 8", 3, "before"},
                         {search + "deadline_s = 8", 3, "deadline_s"},
                         {search + "on_mis = \"abort\"", 3, "on_mis"},
                         {search + "[[clauses]]\nalways = \"altitude <= 0.5 m\"", 3, "clauses"},
                         {search + "within_s = 0", 3, "within_s"},
                         {search + "within_s = 30\nbefore_s = 20", 3, "within_s"}}) {
    expect_refusal(c.text, c.line, c.subject);
  }
}

TEST(Mission, AClauseCanEndTheFlight) {
  const Mission mission = parsed(R"(
[[task]]
task = "hold"
[[clause]]
always = "from_start <= 5 m"
ends_flight = true
[[clause]]
never = "altitude >= 3 m"
)");
  EXPECT_TRUE(mission.clauses.at(0).ends_flight);
  EXPECT_FALSE(mission.clauses.at(1).ends_flight);
}

TEST(Mission, RefusesClausesThatCannotBe) {
  const std::string always = "always = \"altitude <= 1 m\"\n";
  const std::string eventually = "eventually = \"altitude <= 1 m\"\n";
  struct Case {
    std::string clause;
    int line;  // in the clause; 0 is its header
    const char* subject;
  };
  for (const Case& c : std::vector<Case>{
           {"", 0, "[clause]"},
           {"always = \"altitude <= 1 ft\"", 1, "always"},
           {always + "never = \"speed >= 1 m/s\"", 2, "never"},
           {"eventually = \"altitude <= 1 m in 95 %\"", 1, "eventually"},
           {"eventually = \"reaction_time <= 1 s\"", 1, "eventually"},
           {"within_s = 3\nbefore_s = 4", 2, "before_s"},
           {always + "within_s = 3", 2, "within_s"},
           {always + "for_s = 3", 2, "for_s"},
           {eventually + "for_s = 3\nwithin_s = 2", 2, "for_s"},
           {always + "after = \"flight\"", 2, "after"},
           {always + "during = [\"fly\", \"flight\"]", 2, "during"},
           {always + "during = [\"fly\", \"find\"]", 2, "during"},
           {always + "during = []", 2, "during"},
           {always + "during = [\"fly\"]\nafter = \"find\"", 2, "during"},
           {always + "until = \"fly\"", 2, "until"},
           {eventually + "ends_flight = true", 2, "ends_flight"},
           {always + "during = [\"fly\"]\nends_flight = true", 3, "ends_flight"},
           {"always = \"altitude <= 1 m in 95 %\"\nends_flight = true", 2, "ends_flight"},
           {"never = \"data_age >= 1 s\"\nends_flight = true", 2, "ends_flight"},
           {always + "[[clause]]\n" + always, 2, "mission: always altitude <= 1 m"}}) {
    expect_refusal(kTasks + "[[clause]]\n" + c.clause, 11 + c.line, c.subject);
  }
  expect_refusal("[[task]]\ntask = \"a\"\n[[clause]]\nalways = \"distance <= 1 m\"", 4, "always");
}

TEST(Mission, MustFitTheScenario) {
  const Mission mission = parsed(kTasks + R"([[clause]]
name = "near"
eventually = "distance <= 1 m"
within_s = 20
)");
  EXPECT_NO_THROW(require_possible(mission, {{"blue_box"}, 20s}));
  for (const Surroundings& other :
       {Surroundings{{"blue_box"}, 19s}, Surroundings{{"red_box"}, 60s}, Surroundings{{}, 60s}}) {
    const Error error = bad_file_error([&] { require_possible(mission, other); });
    EXPECT_EQ(error.where(), (FileLocation{"m.toml", 11}));
    EXPECT_EQ(error.subject(), "near");
  }
}

TEST(Mission, NeedsABatteryForClausesAboutIt) {
  for (const char* condition : {"charge_left >= 30 %", "energy_j <= 4 kJ"}) {
    const Mission mission =
        parsed(kTasks + "[[clause]]\nname = \"b\"\nalways = \"" + condition + "\"\n");
    EXPECT_EQ(bad_file_error([&] { require_possible(mission, {{}, 60s}); }).subject(), "b");
    EXPECT_NO_THROW(require_possible(mission, {{}, 60s, true}));
  }
}

TEST(Mission, ShippedFilesAreGood) {
  for (const auto& entry : std::filesystem::directory_iterator(TETHER_SOURCE_DIR "/data/missions"))
    EXPECT_FALSE(load_mission(entry.path()).tasks.empty());
}

TEST(LoadMission, AFenceIsNamedByItsClauses) {
  const std::string fence = "[[fence]]\nname = \"yard\"\nx_m = [0, 10, 10]\ny_m = [0, 0, 8]\n";
  const std::string clause = "[[clause]]\nalways = \"inside of yard >= 0.5 m\"\n";
  const Mission mission = parsed(kTasks + fence + clause);
  const Condition& condition = *mission.clauses.at(0).condition;
  ASSERT_EQ(condition.fence.size(), 3u);
  EXPECT_EQ(condition.fence[2].x_m, 10.0);
  EXPECT_EQ(condition.fence[2].y_m, 8.0);
  EXPECT_EQ(mission.clauses[0].name, "mission: always inside of yard >= 0.5 m");
  expect_refusal(kTasks + clause, 12, "always");
  expect_refusal(kTasks + fence + "[[clause]]\nalways = \"inside >= 0.5 m\"\n", 16, "always");
  expect_refusal(kTasks + fence + fence, 16, "name");
  expect_refusal(kTasks + "[[fence]]\nname = \"yard\"\nx_m = [0, 1]\ny_m = [0, 1]\n", 13, "x_m");
  expect_refusal(kTasks + "[[fence]]\nname = \"yard\"\nx_m = [0, 1, 2]\ny_m = [0, 1]\n", 13, "x_m");
}

}  // namespace
}  // namespace tether::mission
