#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/base_testing/thrown_error.h>
#include <tether/campaign/campaign_folder.h>
#include <tether/shards/shard.h>

namespace tether::shards {
namespace {

TEST(Shard, IsANumberOfAWhole) {
  EXPECT_EQ(parse_shard("3/8"), (Shard{3, 8}));
  EXPECT_EQ(parse_shard("1/1"), Shard{});
  for (const char* text : {"", "3", "0/8", "9/8", "-1/8", "1/0", "1/8 ", "1/8/2", "a/b", "1/",
                           "99999999999999999999999/1"})
    EXPECT_EQ(thrown_error(ErrorCode::kUsage, [&] { parse_shard(text); }).subject(), "--shard")
        << text;
}

TEST(Shard, TakesEachTrialOnceWithTheOthers) {
  for (std::size_t of = 1; of < 10; ++of)
    for (std::size_t index = 0; index < 30; ++index) {
      std::size_t takers = 0;
      for (std::size_t number = 1; number <= of; ++number)
        if (Shard{number, of}.takes(index)) ++takers;
      EXPECT_EQ(takers, 1u);
    }
}

// Otherwise, each of two machines would fly one of two conditions.
TEST(TrialList, NumbersItsSeedsWithAllTheirConditions) {
  EXPECT_THAT(seed_numbers({{"turn/a/seed-0001", ""},
                            {"turn/b/seed-0001", ""},
                            {"turn/a/seed-0002", ""},
                            {"turn/b/seed-0002", ""},
                            {"dock/a/seed-0001", ""}}),
              testing::ElementsAre(0, 0, 1, 1, 2));
}

TEST(TrialList, IsTheSameAfterItsText) {
  const TrialList list{.files = {{"/a \"b\"", "1f"}, {"/c", ""}},
                       .measures = true,
                       .trials = {{"turn/host/seed-0001", "{\"a\": \"\\n\"}"}, {"x", ""}}};
  EXPECT_EQ(parse_trial_list(to_json(list), "list"), list);
  EXPECT_EQ(parse_trial_list(to_json(TrialList{}), "list"), TrialList{});
  for (const char* text : {"", "{}", "[]", "{\"files\": 1, \"measures\": true, \"trials\": []}"})
    EXPECT_EQ(bad_file_error([&] { parse_trial_list(text, "list"); }).where().file, "list");
}

TEST(TrialList, NeedsTheSameContentOfItsFiles) {
  const ScratchFolder scratch;
  const auto a = scratch.write("a", "1"), b = scratch.write("b", "2");
  const auto digests = digests_of({a, b, a});
  require_same_files(digests);
  scratch.write("b", "2");  // written again
  require_same_files(digests);
  scratch.write("b", "3");
  EXPECT_EQ(bad_file_error([&] { require_same_files(digests); }).where().file, b.string());
  std::filesystem::remove(a);
  EXPECT_EQ(bad_file_error([&] { require_same_files(digests); }).where().file, a.string());
}

TEST(TrialList, NeedsEqualMachinesIfItMeasures) {
  const ScratchFolder scratch;
  std::filesystem::create_directory(scratch.path(std::string(campaign::kShardsFolder)));
  require_same_machine(scratch.path(), "one");
  require_same_machine(scratch.path(), "one");
  const Error error = bad_file_error([&] { require_same_machine(scratch.path(), "other"); });
  EXPECT_THAT(error.what(),
              testing::HasSubstr("measured on \"one\", and this machine is \"other\""));
}

}  // namespace
}  // namespace tether::shards
