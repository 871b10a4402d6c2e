#include "fake_cluster.h"

#include <set>

#include <gtest/gtest.h>

#include <tether/base_testing/thrown_error.h>

namespace tether::workers {
namespace {

class RoundTest : public testing::Test {
 protected:
  std::vector<Item> many(std::size_t count) const {
    std::vector<Item> items;
    for (std::size_t i = 0; i < count; ++i)
      items.push_back({"s/c/seed-" + std::to_string(i), "seed " + std::to_string(i)});
    return items;
  }
  FakeCampaign fake_;
};

TEST_F(RoundTest, KeepsItsSettingsAndItems) {
  RoundSettings settings{.job = "tether-1", .chunk = 2};
  settings.files = {{"/a", "12"}};
  settings.command = {{"campaign", "/x.toml"}};
  std::vector<Item> items = many(5);
  items[3].losses = {"n1: \"quoted\"\nline"};
  ASSERT_TRUE(create_round(fake_.folder, 1, settings, items));
  const auto round = newest_round(fake_.folder);
  settings.items = 5;
  EXPECT_EQ(round->settings(), settings);
  EXPECT_EQ(round->items(0), items);
}

TEST_F(RoundTest, CutsEveryNumberOfItemsIntoChunksOnce) {
  std::size_t number = 0;
  for (const std::size_t count : {1u, 2u, 63u, 64u, 65u, 128u, 129u, 500u}) {
    for (const std::size_t chunk : {1u, 2u, 3u, 32u}) {
      const auto round = create_round(fake_.folder, ++number, {.chunk = chunk}, many(count));
      std::set<std::size_t> seen;
      for (std::size_t shard = 0; shard < round->shards(); ++shard) {
        EXPECT_GT(round->chunks(shard), 0u);
        std::size_t of_shard = 0;
        for (std::size_t c = 0; c < round->chunks(shard); ++c)
          for (std::size_t i = round->first_item({shard, c}); i < round->end_item({shard, c}); ++i)
            of_shard += seen.insert(i).second;
        EXPECT_EQ(round->items(shard).size(), of_shard);
      }
      EXPECT_EQ(seen.size(), count) << "in chunks of " << chunk;
    }
  }
}

TEST_F(RoundTest, IsMadeByOneOfTwoCollectors) {
  EXPECT_TRUE(create_round(fake_.folder, 1, {.job = "first"}, many(3)));
  EXPECT_FALSE(create_round(fake_.folder, 1, {.job = "second"}, many(3)));
  EXPECT_EQ(newest_round(fake_.folder)->settings().job, "first");
  EXPECT_EQ(fake_.folder.list(".tether-workers/rounds").size(), 1u);
}

TEST_F(RoundTest, IgnoresOneThatWasBeingMade) {
  EXPECT_FALSE(newest_round(fake_.folder));
  fake_.scratch.write("out/.tether-workers/rounds/.half/round.json", "{");
  EXPECT_FALSE(newest_round(fake_.folder));
}

TEST_F(RoundTest, RefusesADamagedFile) {
  const auto file = fake_.scratch.write("out/.tether-workers/rounds/0001/round.json", "{\"job\":");
  EXPECT_EQ(bad_file_error([&] { (void)newest_round(fake_.folder); }).where().file, file.string());
}

}  // namespace
}  // namespace tether::workers
