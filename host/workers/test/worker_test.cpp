#include "fake_cluster.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base/error.h>
#include <tether/base_testing/thrown_error.h>

namespace tether::workers {
namespace {

using testing::SizeIs;

class WorkerTest : public testing::Test {
 protected:
  WorkerEnd run(WorkerSetup setup) { return work(*newest_round(fake_.folder), setup); }
  std::vector<std::string> lost() const { return fake_.folder.list(round_->path("lost")); }

  FakeCampaign fake_;
  std::optional<Round> round_ =
      create_round(fake_.folder, 1, {.job = "j", .chunk = 2}, fake_.items());
};

TEST_F(WorkerTest, FliesEverythingOnceAndEnds) {
  const WorkerEnd end = run(fake_.worker("a"));
  EXPECT_EQ(end.flown, 9u);
  EXPECT_EQ(end.why_early, "");
  EXPECT_EQ(fake_.results(), 9u);
  EXPECT_TRUE(read_workers(*round_).at("a").has_ended);
  EXPECT_EQ(run(fake_.worker("b")).flown, 0u);
  EXPECT_THAT(fake_.flown, SizeIs(9));
  EXPECT_THAT(fake_.folder.list(".tether-workers/staging/a"), SizeIs(0));
}

TEST_F(WorkerTest, LeavesTheResultOfAFasterWorker) {
  const auto there = fake_.scratch.write("out/turn/host/seed-0001/result.json", "of another");
  EXPECT_EQ(run(fake_.worker("a")).flown, 8u);
  EXPECT_EQ(os::read_file(there), "of another");
}

TEST_F(WorkerTest, GoesOnAfterATrialThatTheMachineLost) {
  WorkerSetup setup = fake_.worker("a", "n7");
  setup.fly = [&, own = setup.fly](const Item& item, const auto& local, double scale) {
    if (item.folder == "turn/host/seed-0002") return Flight{Flight::End::kLost, "no port"};
    return own(item, local, scale);
  };
  const WorkerEnd end = run(setup);
  EXPECT_EQ(end.flown, 8u);
  EXPECT_EQ(end.lost, 1u);
  ASSERT_THAT(lost(), SizeIs(1));
  const Note note = read_note(fake_.folder, round_->path("lost/" + lost()[0]));
  EXPECT_EQ(note.node, "n7");
  EXPECT_EQ(note.why, "no port");
}

// A machine on which everything fails at once would otherwise lose the whole campaign.
TEST_F(WorkerTest, EndsWhereTheMachineIsBroken) {
  WorkerSetup setup = fake_.worker("a");
  setup.fly = [](const Item&, const auto&, double) {
    return Flight{Flight::End::kLost, "no library"};
  };
  const WorkerEnd end = run(setup);
  EXPECT_EQ(end.lost, kMostLossesInARow);
  EXPECT_NE(end.why_early, "");
  EXPECT_GE(run(fake_.worker("b")).flown, 6u);
}

TEST_F(WorkerTest, LosesTheTrialInHandWhenItIsStopped) {
  std::stop_source stop;
  WorkerSetup setup = fake_.worker("a");
  setup.stop = stop.get_token();
  setup.fly = [&, own = setup.fly](const Item& item, const auto& local, double scale) {
    if (fake_.flown.size() < 3) return own(item, local, scale);
    stop.request_stop();
    return Flight{Flight::End::kStopped, "stopped"};
  };
  EXPECT_EQ(run(setup).flown, 3u);
  EXPECT_THAT(lost(), SizeIs(1));
  EXPECT_TRUE(read_workers(*round_).at("a").has_ended);
}

TEST_F(WorkerTest, DoesNotKeepATrialWhoseCheckFails) {
  WorkerSetup setup = fake_.worker("a");
  setup.check = [] { throw Error(ErrorCode::kBadFile, {"/w.sdf"}, "was changed"); };
  EXPECT_EQ(bad_file_error([&] { run(setup); }).where().file, "/w.sdf");
  EXPECT_EQ(fake_.results(), 0u);
  EXPECT_THAT(lost(), SizeIs(1));
}

TEST_F(WorkerTest, LosesTheTrialThatCannotBeHandedIn) {
  fake_.scratch.write("out/turn", "a file where the results belong");
  thrown_error(ErrorCode::kSetup, [&] { run(fake_.worker("a")); });
  EXPECT_THAT(lost(), SizeIs(1));
  EXPECT_THAT(fake_.folder.list(".tether-workers/staging/a"), SizeIs(0));
}

}  // namespace
}  // namespace tether::workers
