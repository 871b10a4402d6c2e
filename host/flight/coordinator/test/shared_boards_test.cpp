#include "coordinator_fixture.h"

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <tether/base/random.h>

// SUTs that share the cores of a board: when their calls are on the board's time line.
namespace tether::coordinator {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

class SharedBoard : public CoordinatorTest {
 protected:
  void make_shared(std::size_t uavs, int cores) {
    options_.boards = {{"obc", cores}};
    make(uavs);
    for (UavOptions& uav : options_.uavs) {
      uav.board = 0;
      uav.clock = computer::Clock{.kind = computer::ClockKind::kScripted};
    }
    remake();
  }
  std::vector<record::Interaction> of(std::size_t uav) const {
    std::vector<record::Interaction> own;
    std::ranges::copy_if(recorder_.interactions, std::back_inserter(own),
                         [&](const auto& entry) { return entry.uav == name_of(uav); });
    return own;
  }
};

TEST_F(SharedBoard, ComputingTakesAsManyTimesAsLongAsProgramsCompute) {
  make_shared(2, 1);
  options_.uavs[1].computer = "obc";
  remake();
  server_->add_sut(hello(name_of(0)), {turn(milliseconds(3), 0.1), finish(milliseconds(1))});
  server_->add_sut(hello(name_of(1)), {turn(milliseconds(5), 0.1), finish(milliseconds(0))});
  ASSERT_EQ(run().end, RunEnd::kFinished);
  EXPECT_EQ(of(0)[0].request_at, us(6000));
  EXPECT_EQ(of(0)[0].computed, milliseconds(3));
  EXPECT_EQ(of(0)[1].request_at, us(8000));
  EXPECT_EQ(of(1)[0].request_at, us(9000)) << "2 of 5 ms were left at 6 ms, 1 at 8 ms";
  EXPECT_EQ(recorder_.header.suts[1].board, "obc");
  EXPECT_EQ(recorder_.header.suts[1].computer, "obc");
  EXPECT_EQ(recorder_.header.boards, (std::vector<record::BoardInfo>{{"obc", 1}}));
}

TEST_F(SharedBoard, PinnedProgramsShareTheirCoreOnly) {
  make_shared(4, 2);
  for (const std::size_t uav : {0U, 1U, 2U}) options_.uavs[uav].pinned_core = 0;
  remake();
  for (std::size_t uav = 0; uav < 4; ++uav)
    server_->add_sut(hello(name_of(uav)), {finish(milliseconds(2))});
  ASSERT_EQ(run().end, RunEnd::kFinished);
  EXPECT_EQ(of(2)[0].request_at, us(6000));
  EXPECT_EQ(of(3)[0].request_at, us(2000));
  EXPECT_EQ(of(3)[0].computed, milliseconds(2));
}

TEST_F(SharedBoard, TheRecordHasTheBoardOfAProgramThatIsAloneOnItsCore) {
  make_shared(3, 2);
  options_.uavs[1].pinned_core = 0;
  remake();
  for (std::size_t uav = 0; uav < 3; ++uav)
    server_->add_sut(hello(name_of(uav)), {finish(milliseconds(2))});
  ASSERT_EQ(run().end, RunEnd::kFinished);
  EXPECT_EQ(of(0)[0].request_at, us(4000));
  EXPECT_EQ(of(1)[0].request_at, us(2000));
  EXPECT_EQ(recorder_.header.suts[1].board, "obc");
  EXPECT_EQ(recorder_.header.suts[1].pinned_core, 0);
}

TEST_F(SharedBoard, ABoardOnWhichNobodyWaitsIsNotInTheRecord) {
  make_shared(2, 2);
  options_.uavs[1].pinned_core = 1;
  remake();
  for (std::size_t uav = 0; uav < 2; ++uav)
    server_->add_sut(hello(name_of(uav)), {finish(milliseconds(2))});
  ASSERT_EQ(run().end, RunEnd::kFinished);
  EXPECT_EQ(recorder_.header.boards.size(), 0u);
  EXPECT_EQ(of(0)[0].computed, std::nullopt);
}

TEST_F(SharedBoard, AFlooderLeavesItsShareOfTheCoresToTheOthers) {
  for (const bool in_one_step : {true, false}) {
    options_.radio.model = radio::Model::kLogDistance;
    options_.radio.queue_messages = 2;
    make_shared(2, 1);
    const Duration pause = in_one_step ? Duration(0) : Duration(microseconds(2));
    const Act send{pause, link::SendMessage{"", std::vector<std::uint8_t>(60'000)}};
    server_->add_sut(hello(name_of(0)), Script(4'000, send));
    server_->add_sut(hello(name_of(1)), {turn(milliseconds(200), 0.1), finish(milliseconds(100))});
    const RunReport report = run();
    EXPECT_EQ(report.end, RunEnd::kFlooded) << report.reason;
    EXPECT_TRUE(report.suts.at(1).finish) << "the other one is unharmed";
  }
}

TEST_F(SharedBoard, SleepsAndAnnotationsAreOnTheTimeLineOfTheBoard) {
  make_shared(2, 1);
  const link::PeerId peer = server_->add_sut(hello(name_of(0)), {});
  server_->add_sut(hello(name_of(1)), {finish(milliseconds(100))});
  server_->deliver(peer, link::Annotation{us(1000), "task", "{}"});
  bool is_asleep = false, is_woken = false;
  hooks_.should_stop = [&]() -> std::optional<Ending> {
    if (!std::exchange(is_asleep, true))
      server_->deliver(peer, request(1, us(3000), link::Sleep{us(13'000), true}));
    if (server_->sent[peer].size() == 2 && !std::exchange(is_woken, true))
      server_->deliver(peer, request(2, us(16'000), link::Finish{true, "", ""}));
    return std::nullopt;
  };
  const RunReport report = run();
  ASSERT_EQ(report.end, RunEnd::kFinished) << report.reason;
  EXPECT_EQ(of(0)[0].st_at_arrival, st_ms(0)) << "ST does not depend on when annotations arrive";
  EXPECT_EQ(recorder_.annotations.at(0).at, us(2000));
  EXPECT_EQ(of(0)[0].request_at, us(6000));
  EXPECT_EQ(of(0)[0].reply_at, us(16'000));
}

TEST_F(SharedBoard, AStampBeforeAnEarlierProgressIsAViolation) {
  make_shared(2, 1);
  const link::PeerId peer = server_->add_sut(hello(name_of(0)), {});
  server_->add_sut(hello(name_of(1)), {finish(milliseconds(1))});
  server_->deliver(peer, link::Progress{us(500)});
  server_->deliver(peer, request(1, us(300), link::Finish{true, "", ""}));
  ASSERT_EQ(run().end, RunEnd::kFinished);
  EXPECT_TRUE(of(0)[0].violation);
  EXPECT_EQ(of(0)[0].computed, microseconds(500));
}

TEST_F(SharedBoard, IsNotSharedInFreeRunning) {
  set_free_running(1.0);
  make_shared(2, 1);
  for (const std::size_t uav : {0U, 1U})
    server_->add_sut(hello(name_of(uav)), {finish(milliseconds(2))});
  ASSERT_EQ(run().end, RunEnd::kFinished);
  EXPECT_EQ(recorder_.header.boards.size(), 0u);
}

TEST_F(SharedBoard, IsNotModelledIfItIsRealAndThenNeedsConcurrentSuts) {
  make_shared(2, 1);
  options_.boards = {{.name = "obc", .cores = 0, .is_real = true}};
  remake();
  const link::PeerId serial = server_->add_sut(hello(name_of(0)), {});
  for (const std::size_t uav : {0U, 1U})
    server_->add_threads(hello(name_of(uav)), {{finish(milliseconds(3))}});
  ASSERT_EQ(run().end, RunEnd::kFinished);
  EXPECT_EQ(refusal(serial).reason, link::Refusal::Reason::kBadRequest);
  EXPECT_EQ(of(0)[0].request_at, us(3000));
  EXPECT_EQ(recorder_.header.suts[1].board, "obc");
  EXPECT_EQ(recorder_.header.boards, (std::vector<record::BoardInfo>{{"obc", 0, true}}));
}

// Random programs, and messages in a random order: the instants are those of a naive scheduler, the
// rules hold, and every order gives the same record.
TEST_F(SharedBoard, InstantsAndRecordsAreTheSameInAnyOrderOfMessages) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    KeyedRandom random({.seed = seed});
    const std::size_t uavs = 2 + random.bits() % 4;
    const int cores = 1 + static_cast<int>(random.bits() % 2);
    std::vector<Script> scripts(uavs);
    for (Script& script : scripts) {
      const auto work = [&] {
        return microseconds(random.bits() % 3 * 500 + random.bits() % 2 * 7);
      };
      for (std::size_t i = 0; i < 3 + random.bits() % 10; ++i) switch (random.bits() % 4) {
          case 0:
            script.push_back(turn(work(), 0.1));
            break;
          case 1:
            script.push_back(read(work(), kCamera));
            break;
          case 2:
            script.push_back(read(work(), kRange));
            break;
          default:
            script.push_back(sleep(work(), microseconds(random.bits() % 4000)));
        }
      script.push_back(finish(work()));
    }
    std::string first;
    for (std::uint64_t order = 0; order < 4; ++order) {
      make_shared(uavs, cores);
      for (std::size_t uav = 0; uav < uavs; ++uav)
        server_->add_sut(hello(name_of(uav)), scripts[uav]);
      KeyedRandom choice({.seed = seed, .index = order});
      server_->choose = [&](std::size_t waiting) { return choice.bits() % waiting; };
      ASSERT_EQ(run().end, RunEnd::kFinished);
      EXPECT_EQ(recorder_.footer->causality_violations, 0u);
      std::string text = without_wall(recorder_);
      for (const auto& entry : recorder_.interactions) {
        text += "\n" + entry.uav + std::to_string(entry.computed.value_or(Duration(-1)).count());
        EXPECT_EQ(entry.st_at_release, simulator_->grid().floor(same_instant(entry.reply_at)))
            << "rule 3";
        EXPECT_LE(entry.st_at_arrival, simulator_->grid().floor(same_instant(entry.request_at)))
            << "rule 4";
      }
      if (order == 0) first = text;
      ASSERT_EQ(text, first) << "seed " << seed << ", order " << order;
    }
  }
}

}  // namespace
}  // namespace tether::coordinator
