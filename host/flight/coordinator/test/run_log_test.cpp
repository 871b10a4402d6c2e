#include "run_log.h"

#include "coordinator_fixture.h"

#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include <tether/base/random.h>
#include <tether/base_testing/scratch_folder.h>

namespace tether::coordinator {
namespace {

using std::chrono::microseconds;

// Often at the same ET as others, at and between boundaries.
ScriptedServer::Script drawn_script(KeyedRandom& random) {
  ScriptedServer::Script script;
  for (int i = 0; i < 30; ++i) {
    const Duration compute = microseconds(250 * (random.bits() % 5));
    const unsigned kind = random.bits() % 4;
    if (kind == 0) script.push_back(read(compute, kImu));
    if (kind == 1) script.push_back(sleep(compute, microseconds(500 * (random.bits() % 3))));
    if (kind >= 2) script.push_back(turn(compute, 0.1 * i));
  }
  script.push_back(finish(Duration(0)));
  return script;
}

class RunLogTest : public CoordinatorTest {
 protected:
  /// The bytes of the record of three SUTs, whose messages arrive in an order drawn from `order`.
  std::string fly(std::uint64_t seed, std::uint64_t order) {
    const ScratchFolder folder;
    const auto file = folder.path("record.mcap");
    make(3);
    KeyedRandom random({seed});
    for (const char* uav : {"uav0", "uav1", "uav2"})
      server_->add_sut(hello(uav), drawn_script(random));
    KeyedRandom race({seed, order});
    server_->choose = [&](std::size_t count) { return race.bits() % count; };
    now_ += std::chrono::seconds(order);
    options_.header.machine = "machine " + std::to_string(order);
    options_.header.target = record::TargetInfo{"host", "", {{"load", std::to_string(order)}}};
    hooks_.read_target = [&] { return options_.header.target->before; };
    const auto recorder = record::make_mcap_recorder(file);
    Coordinator coordinator(*simulator_, *recorder, options_, [this] { return now_ += tick_; });
    EXPECT_EQ(coordinator.run(*server_, hooks_).end, RunEnd::kFinished);
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
};

// Which of the SUTs' messages arrives first is a matter of the machine's load.
TEST_F(RunLogTest, WithScriptedClocksTheRecordIsTheSameToTheByte) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    std::set<std::string> records;
    for (std::uint64_t order = 0; order < 8; ++order) records.insert(fly(seed, order));
    EXPECT_EQ(records.size(), 1u) << "seed " << seed;
  }
}

record::Header header_of_two() {
  record::Header header;
  for (const char* uav : {"a", "b"}) header.suts.emplace_back().uav = uav;
  return header;
}

record::Interaction at(const std::string& uav, std::int64_t request_us, std::int64_t reply_us) {
  record::Interaction m;
  m.uav = uav;
  m.request_at = us(request_us);
  m.reply_at = us(reply_us);
  m.st_at_arrival = st_ms(1);
  m.wall_at_arrival = from_ns<WallTime>(50);
  m.wall_at_release = from_ns<WallTime>(40);
  return m;
}

// Of two replies at ST 1 ms, that of "b" comes first. Whether the record has it second.
bool is_moved(const record::Interaction& b, const record::Interaction& a, bool repeatable = true) {
  MemoryRecorder recorder;
  RunLog log(recorder);
  log.begin(header_of_two(), repeatable);
  log.race_again();
  log.interaction(st_ms(1), b);
  log.interaction(st_ms(1), a);
  log.end();
  return recorder.interactions.at(0).uav == "a";
}

TEST(RunLog, MovesOnlyRepliesThatTheRulesLeaveUnordered) {
  const record::Interaction b = at("b", 1000, 1500);
  EXPECT_TRUE(is_moved(b, at("a", 1100, 1400)));
  EXPECT_TRUE(is_moved(b, at("a", 1500, 1500))) << "the smaller index";
  EXPECT_TRUE(is_moved(at("b", 1000, 1000), at("a", 1000, 1000)));
  EXPECT_FALSE(is_moved(b, at("a", 1600, 1700)));
  EXPECT_FALSE(is_moved(b, at("a", 1100, 1400), false));
  // These were sent too early.
  EXPECT_FALSE(is_moved(b, at("a", 1000, 1400))) << "the barrier has to wait for it";
  record::Interaction held = at("a", 1100, 1400);
  held.wall_at_arrival = from_ns<WallTime>(39);
  EXPECT_FALSE(is_moved(b, held));
  held = at("a", 1100, 1400);
  held.st_at_arrival = st_ms(0);
  EXPECT_FALSE(is_moved(b, held));
}

}  // namespace
}  // namespace tether::coordinator
