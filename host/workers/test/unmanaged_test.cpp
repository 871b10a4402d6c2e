#include "fake_cluster.h"

#include <gtest/gtest.h>

#include <tether/base_testing/thrown_error.h>

namespace tether::workers {
namespace {

// By the collector's clock alone: what the worker's file says matters only where it changes.
TEST(Unmanaged, AWorkerIsAliveWhileItsFileChanges) {
  FakeCampaign fake;
  const auto round = create_round(fake.folder, 1, {.beats = true}, fake.items());
  Duration now{0};
  const auto engine = make_unmanaged([&] { return now; });
  const auto beat = [&](int count, bool ended = false) {
    fake.folder.replace(round->path("workers/w"),
                        R"({"worker":"w","node":"n1","beat":)" + std::to_string(count) +
                            R"(,"ended":)" + (ended ? "true}" : "false}"),
                        "test");
  };
  const auto is_alive = [&] { return engine->tasks(*round)->at(0).is_alive; };
  EXPECT_TRUE(engine->tasks(*round)->empty());
  beat(100);
  EXPECT_TRUE(is_alive());
  now += kSilence - Duration(1);
  EXPECT_TRUE(is_alive());
  beat(99);
  EXPECT_TRUE(is_alive());
  now += kSilence - Duration(1);
  EXPECT_TRUE(is_alive());
  now += Duration(1);
  EXPECT_FALSE(is_alive());
  beat(101);
  EXPECT_TRUE(is_alive());
  beat(102, true);
  EXPECT_FALSE(is_alive());
}

TEST(Unmanaged, LeavesStartingAndEndingToTheUser) {
  FakeCampaign fake;
  const auto round = create_round(fake.folder, 1, {}, fake.items());
  const auto engine = make_unmanaged([] { return Duration(0); });
  EXPECT_FALSE(engine->start(*round, {}));
  EXPECT_EQ(thrown_error(ErrorCode::kUsage, [&] { engine->cancel(*round); }).subject(), "--cancel");
}

}  // namespace
}  // namespace tether::workers
