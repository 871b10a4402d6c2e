#include "support/trials.h"

#include <algorithm>
#include <atomic>
#include <map>
#include <ostream>
#include <regex>
#include <thread>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <tether/os/machine.h>
#include <tether/scenario/scenario.h>
#include <tether/scenario/shipped_files.h>

/// Every shipped program flies under every shipped condition and target that claims to support it.
/// What is shipped is found when the test starts, so a new file joins by itself. Each flight is so
/// short that few goals are reached; system_flights flies them to their ends. At each change, all
/// conditions and every sixth pair of a scenario and a target ("Data"); the other pairs before a
/// release ("Pairs").
namespace tether::system_test {
namespace {

using scenario::ShippedKind;

struct Flight {
  std::string scenario;
  std::string condition;
  std::optional<scenario::Target> target{};  // of the command line
  bool concurrent = false;
  std::string skipped{};  // why
  double limit_s = 0.3;   // of ST
  bool each_change = true;

  std::string name() const {
    return scenario::slug(scenario + " " + condition + (target ? " on " + target->name : "") +
                          (concurrent ? " concurrent" : ""));
  }
};

void PrintTo(const Flight& flight, std::ostream* stream) {
  *stream << flight.name();
}

std::string why_skipped(const scenario::Condition& condition, std::size_t suts) {
  if (condition.simulator != "mujoco") return "needs " + condition.simulator;
  if (!condition.computers[0].target) return "";
  if (condition.computers[0].target->ssh) return "needs a board";
  if (static_cast<std::size_t>(condition.computers[0].target->cores) * suts >
      os::allowed_cpus().size())
    return "needs more cores";
  const auto& programs = condition.computers[0].target->program_folder;
  const bool are_there = programs.empty() || std::filesystem::exists(programs);
  return are_there ? "" : "needs programs for ARM: run scripts/build-arm64";
}

/// `first_pair`: which of the targets is the first that flies at each change.
std::vector<Flight> flights_of(const std::string& name,
                               const std::vector<scenario::Target>& targets,
                               std::size_t first_pair) {
  std::vector<Flight> flights;
  const auto loaded =
      scenario::load_scenario(TETHER_SOURCE_DIR "/data/scenarios/" + name + ".toml");
  const bool is_as_is = loaded.uavs.front().sut.is_as_is;
  const auto limit_s = [&](const computer::Clock& clock) {
    // An interpreter with its libraries takes a second to start on a busy machine, times the
    // factor.
    if (is_as_is) return 3.0 + 2.0 * clock.factor;
    return std::max(0.3, 12.0 * to_seconds(clock.computing));
  };
  for (const scenario::Condition& condition : loaded.conditions) {
    // By --target, below. The folder of programs is not found from a copy of the scenario.
    if (condition.computers[0].target && !condition.computers[0].target->program_folder.empty())
      continue;
    flights.push_back({name,
                       condition.name,
                       {},
                       false,
                       why_skipped(condition, loaded.uavs.size()),
                       limit_s(condition.computers[0].clock)});
  }
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const scenario::Target& target = targets[i];
    // face_anchor has a condition with it, and the emulator takes long for its many images.
    if (target.name == "counted_host") continue;
    scenario::Condition condition = loaded.conditions.front();
    if (!why_not_on(condition, target).empty()) continue;
    // Emulators are refused.
    if (is_as_is && (target.emulator || !target.program_folder.empty())) continue;
    place_on(condition, target);
    const std::string skipped = why_skipped(condition, loaded.uavs.size());
    for (const bool concurrent : {false, true})
      if (!concurrent || (target.clock.kind == computer::ClockKind::kWall && !is_as_is))
        flights.push_back({name, loaded.conditions.front().name, target, concurrent, skipped,
                           limit_s(target.clock), (i + first_pair) % 6 == 0});
  }
  return flights;
}

std::vector<Flight> shipped_flights(bool each_change) {
  const scenario::ShippedFiles shipped(TETHER_SOURCE_DIR "/data");
  std::vector<scenario::Target> targets;
  for (const auto& [name, description] : shipped.list(ShippedKind::kTarget))
    targets.push_back(scenario::load_target(shipped.find(ShippedKind::kTarget, name)));
  std::vector<Flight> flights;
  std::size_t first_pair = 0;
  for (const auto& [name, description] : shipped.list(ShippedKind::kScenario))
    for (Flight& flight : flights_of(name, targets, first_pair++))
      if (flight.each_change == each_change) flights.push_back(std::move(flight));
  return flights;
}

/// Without furniture and pictures, which take longer to load than the flight takes.
void write_bare_worlds(const std::filesystem::path& folder) {
  std::filesystem::create_directory(folder);
  const std::regex unneeded("<include>[^]*?</include>|<albedo_map>[^<]*</albedo_map>");
  for (const auto& world : std::filesystem::directory_iterator(TETHER_SOURCE_DIR "/data/worlds"))
    write_text(folder / world.path().filename(),
               std::regex_replace(read_text(world.path()), unneeded, ""));
}

struct Landed {
  Output output;
  nlohmann::json result;
};

Landed fly(const Flight& flight) {
  const TempFolder folder;
  std::vector<Substitution> changes{
      {"\ntime_limit_s = ",  // emulated programs start slowly
       fmt::format("\nconnect_limit_s = 170\ntime_limit_s = {}  # ", flight.limit_s)}};
  const auto original = read_text(TETHER_SOURCE_DIR "/data/scenarios/" + flight.scenario + ".toml");
  // The bare world, and missions without clauses: their deadlines are beyond limit_s.
  const std::regex named("\n(world|mission) = \"(\\w+)\"");
  for (std::sregex_iterator at(original.begin(), original.end(), named), end; at != end; ++at) {
    const std::string name = at->str(2);
    changes.emplace_back(at->str(), at->str(1) == "world"
                                        ? "\nworld = \"../worlds/" + name + ".sdf\""
                                        : "\nfiles.mission = \"" TETHER_SOURCE_DIR
                                          "/data/missions/" +
                                              name + ".toml\"");
  }
  if (flight.concurrent) changes.emplace_back("[sut]", "[sut]\nconcurrent = true");
  const auto file = write_shipped_scenario(folder.path(), flight.scenario, changes);
  write_bare_worlds(folder / "worlds");
  std::vector<std::string> words{"run",   file,          "--quiet", "--condition", flight.condition,
                                 "--out", folder / "out"};
  if (flight.target) words.insert(words.end(), {"--target", flight.target->file});
  Landed landed{run(tether(words), std::chrono::minutes(3)), {}};
  if (std::filesystem::exists(folder / "out/result.json"))
    landed.result = read_result(folder / "out");
  return landed;
}

class ShippedFlight : public testing::TestWithParam<Flight> {
 protected:
  /// Two at a time, because a flight waits as often as it computes.
  static void SetUpTestSuite() {
    const auto* suite = testing::UnitTest::GetInstance()->current_test_suite();
    const auto flights = shipped_flights(std::string(suite->name()).starts_with("Data"));
    std::vector<Landed> landed(flights.size());
    std::atomic<std::size_t> next = 0;
    const auto work = [&] {
      for (std::size_t i = next++; i < flights.size(); i = next++)
        if (flights[i].skipped.empty()) landed[i] = fly(flights[i]);
    };
    {
      const std::jthread other(work);
      work();
    }
    for (std::size_t i = 0; i < flights.size(); ++i) landed_[flights[i].name()] = landed[i];
  }

  static inline std::map<std::string, Landed> landed_;
};

TEST_P(ShippedFlight, Flies) {
  if (!GetParam().skipped.empty()) GTEST_SKIP() << GetParam().skipped;
  const auto& [output, result] = landed_.at(GetParam().name());
  ASSERT_FALSE(result.is_null()) << output.err;
  EXPECT_NE(result["outcome"], "failed") << result["reason"];
  EXPECT_TRUE(result["audit"]["passed"]) << result["audit"]["summary"];
  EXPECT_GT(result["sync"]["interactions"], 0);
}

std::string case_name(const testing::TestParamInfo<Flight>& one) {
  std::string name = one.param.name();
  std::ranges::replace(name, '-', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Data, ShippedFlight, testing::ValuesIn(shipped_flights(true)), case_name);
INSTANTIATE_TEST_SUITE_P(Pairs, ShippedFlight, testing::ValuesIn(shipped_flights(false)),
                         case_name);

}  // namespace
}  // namespace tether::system_test
