#include "test_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/scenario/campaign.h>

namespace tether::scenario {
namespace {

using testing::ElementsAre;

class LoadCampaign : public testing::Test {
 protected:
  LoadCampaign() { write_project(scratch_, kFullScenario); }
  Campaign load(const std::string& text) const {
    return load_campaign(scratch_.write("campaign.toml", text));
  }
  Campaign load_with(const std::string& from, const std::string& to) const {
    return load(replaced(kFullCampaign, from, to));
  }
  ScratchFolder scratch_;
};

TEST_F(LoadCampaign, ReadsAll) {
  const Campaign campaign = load(kFullCampaign);
  EXPECT_EQ(campaign.name, "study");
  EXPECT_EQ(campaign.description, "a study");
  EXPECT_FALSE(campaign.images_of_first_seed);
  EXPECT_TRUE(
      load_with("trials = 3", "trials = 3\nimages_of_first_seed = true").images_of_first_seed);
  EXPECT_THAT(campaign.seeds, ElementsAre(11u, 12u, 13u));
  ASSERT_EQ(campaign.scenarios.size(), 1u);
  EXPECT_EQ(campaign.scenarios[0].scenario.name, "full");
  EXPECT_THAT(campaign.scenarios[0].conditions, ElementsAre("target, no sync", "host"));
  EXPECT_EQ(campaign.scenarios[0].paper_table, "III");
}

TEST_F(LoadCampaign, TakesSeedsAndAllConditions) {
  const Campaign campaign =
      load("name = \"c\"\nseeds = [5, 2]\n[[scenario]]\nfile = \"scenario.toml\"\n");
  EXPECT_THAT(campaign.seeds, ElementsAre(5u, 2u));
  EXPECT_THAT(campaign.scenarios[0].conditions,
              ElementsAre("host", "target, no sync", "scripted", "slow machine"));
  EXPECT_EQ(campaign.scenarios[0].paper_table, "");
  EXPECT_TRUE(campaign.scenarios[0].profile.empty());
}

TEST_F(LoadCampaign, AScenarioAloneIsACampaignOfItsConditions) {
  const Scenario scenario = load_scenario(scratch_.path("scenario.toml"));
  const Campaign all = campaign_of(scenario, {}, 3);
  EXPECT_EQ(all.file, scenario.file);
  EXPECT_THAT(all.seeds, ElementsAre(1u, 2u, 3u));
  EXPECT_THAT(all.scenarios[0].conditions,
              ElementsAre("host", "target, no sync", "scripted", "slow machine"));
  EXPECT_THAT(campaign_of(scenario, {"scripted"}, 1).scenarios[0].conditions,
              ElementsAre("scripted"));
  thrown_error(ErrorCode::kUsage, [&] { campaign_of(scenario, {"fast"}, 1); });
  thrown_error(ErrorCode::kUsage, [&] { campaign_of(scenario, {"host", "host"}, 1); });
}

TEST_F(LoadCampaign, AppliesItsProfileOnTopOfTheScenarios) {
  const auto file = scratch_.write("top.toml", replaced(kRigProfile, "\"rig\"", "\"top\""));
  const CampaignScenario entry =
      load_with("paper_table", "profile = \"top.toml\"\npaper_table").scenarios[0];
  EXPECT_EQ(entry.profile, file);
  EXPECT_THAT(entry.scenario.files, testing::Contains(file));
  EXPECT_THAT(profile_names(entry.scenario, *entry.scenario.find_condition("scripted")),
              ElementsAre("rig", "fog", "top"));
}

TEST_F(LoadCampaign, RefusesWhatCannotBeRun) {
  const std::string trials = "trials = 3\nfirst_seed = 11";
  const std::vector<WrongChange> changes = {
      {"trials = 3", "trials = 0", 3, "trials"},
      {"trials = 3", "seeds = [1]\ntrials = 3", 4, "trials"},
      {"trials = 3", "seeds = [1]", 4, "first_seed"},
      {trials, "seeds = [1, 1]", 3, "seeds"},
      {trials, "seeds = []", 3, "seeds"},
      {trials, "seeds = [-1]", 3, "seeds"},
      {"\"host\"", "\"hots\"", 8, "conditions"},
      {", \"host\"", ", \"target, no sync\"", 8, "conditions"},
      {"[\"target, no sync\", \"host\"]", "[]", 8, "conditions"},
      {"\"III\"", "\"3\"", 9, "paper_table"},
      {"\"scenario.toml\"", "\"none.toml\"", 7, "file"},
      {"paper_table", "profile = \"none.toml\"\npaper_table", 9, "profile"},
      {"\"III\"\n", "\"III\"\n[[scenario]]\nfile = \"scenario.toml\"\n", 11, "file"}};
  for (const WrongChange& change : changes)
    expect_refusal(change.line, change.subject, [&] { load_with(change.from, change.to); });
}

std::vector<std::string> names_of(const Campaign& campaign) {
  std::vector<std::string> names;
  for (const CampaignScenario& entry : campaign.scenarios) names.push_back(entry.scenario.name);
  return names;
}

TEST_F(LoadCampaign, SweepsAllCombinationsOrPairs) {
  const std::string keys = "time_limit_s = [50, 60]\ncondition.cpu_factor = [1, 2.5]\n";
  const Campaign grid = load_with("[[scenario]]", "[sweep]\n" + keys + "[[scenario]]");
  EXPECT_THAT(
      names_of(grid),
      ElementsAre("full-cpu_factor-1-time_limit_s-50", "full-cpu_factor-1-time_limit_s-60",
                  "full-cpu_factor-2.5-time_limit_s-50", "full-cpu_factor-2.5-time_limit_s-60"));
  EXPECT_EQ(grid.scenarios[2].scenario.find_condition("host")->computers[0].clock.factor, 2.5);
  EXPECT_EQ(grid.scenarios[2].swept_from, "full");
  EXPECT_THAT(
      names_of(load_with("[[scenario]]", "[sweep]\npaired = true\n" + keys + "[[scenario]]")),
      ElementsAre("full-cpu_factor-1-time_limit_s-50", "full-cpu_factor-2.5-time_limit_s-60"));
}

TEST_F(LoadCampaign, RefusesSweepsThatCannotBeFlown) {
  const std::pair<const char*, const char*> cases[] = {
      {"sut.parameters.nonsense = [1]", "sweep"},
      {"time_limit_s = [-1]", "sweep"},
      {"time_limit_s = 5", "time_limit_s"},
      {"time_limit_s = []", "time_limit_s"},
      {"time_limit_s = [5, 5]", "time_limit_s"},
      {"paired = true\ntime_limit_s = [5]\ncondition.cpu_factor = [1, 2]", "paired"},
      {"paired = true", "sweep"},
      {"\"condition.name\" = [\"a\", \"b\"]", "condition.name"},
      {"", "sweep"}};
  for (const auto& [text, subject] : cases) {
    SCOPED_TRACE(text);
    const Error error = bad_file_error([&, text = std::string(text)] {
      load_with("[[scenario]]", "[sweep]\n" + text + "\n[[scenario]]");
    });
    EXPECT_EQ(error.subject(), subject);
    EXPECT_TRUE(error.where().file.ends_with("campaign.toml")) << error.what();
    EXPECT_GE(error.where().line, 5);
  }
}

TEST_F(LoadCampaign, LocatesErrorsInTheScenario) {
  const auto file = write_project(scratch_, replaced(kFullScenario, "step_ms = 2", "step_ms = 0"));
  expect_refusal(4, "step_ms", [&] { load(kFullCampaign); });
  EXPECT_EQ(bad_file_error([&] { load(kFullCampaign); }).where().file, file);
}

}  // namespace
}  // namespace tether::scenario
