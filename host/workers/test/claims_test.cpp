#include "fake_cluster.h"

#include <map>
#include <thread>

#include <gtest/gtest.h>

namespace tether::workers {
namespace {

std::vector<Item> many_items(std::size_t count) {
  return std::vector<Item>(count, Item{"s/c/x", {}});
}

TEST(Claims, GiveEachChunkToOneOfManyWorkers) {
  FakeCampaign fake;
  const auto round = create_round(fake.folder, 1, {.chunk = 3}, many_items(1000));
  std::vector<std::vector<Chunk>> of_worker(8);
  {
    std::vector<std::jthread> workers;
    for (std::size_t w = 0; w < of_worker.size(); ++w)
      workers.emplace_back([&, w] {
        Claims claims(*round, {"w" + std::to_string(w), "n", ""});
        while (const auto chunk = claims.next()) of_worker[w].push_back(*chunk);
      });
  }
  std::map<Chunk, int> claimed;
  for (const auto& chunks : of_worker)
    for (const Chunk& chunk : chunks) ++claimed[chunk];
  EXPECT_EQ(claimed.size(), 334u);
  for (const auto& [chunk, times] : claimed) EXPECT_EQ(times, 1);
}

// Not even the last of many workers looks at every claim, and an early one claims in one request.
TEST(Claims, NeedFewRequestsWhateverTheNumberOfChunks) {
  FakeCampaign fake;
  constexpr std::size_t kChunks = 20 * kChunksPerShard;
  const auto round = create_round(fake.folder, 1, {.chunk = 1}, many_items(kChunks));
  const auto before = fake.folder.operations();
  Claims first(*round, {"first", "n", ""});
  while (first.next()) {
  }
  EXPECT_LE(fake.folder.operations() - before, kChunks + kChunks / 2);
  const auto then = fake.folder.operations();
  EXPECT_FALSE(Claims(*round, {"late", "n", ""}).next());
  EXPECT_EQ(fake.folder.operations() - then, 1u);
}

}  // namespace
}  // namespace tether::workers
