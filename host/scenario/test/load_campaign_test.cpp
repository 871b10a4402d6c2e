#include "full_scenario.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/scenario/campaign.h>

namespace tether::scenario {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::string kCampaign = R"(name = "study"
description = "a study"
trials = 3
first_seed = 11

[[scenario]]
file = "scenario.toml"
conditions = ["target, no sync", "host"]
paper_table = "III"
)";

class LoadCampaign : public testing::Test {
 protected:
  LoadCampaign() { write_project(scratch_, kFullScenario); }
  Campaign load(const std::string& text) const {
    return load_campaign(scratch_.write("campaign.toml", text));
  }
  std::string error_with(const std::string& from, const std::string& to) const {
    return bad_file_message([&] { load(replaced(kCampaign, from, to)); });
  }
  ScratchFolder scratch_;
};

TEST_F(LoadCampaign, ReadsAll) {
  const Campaign campaign = load(kCampaign);
  EXPECT_EQ(campaign.name, "study");
  EXPECT_EQ(campaign.description, "a study");
  EXPECT_FALSE(campaign.images_of_first_seed);
  EXPECT_TRUE(load(replaced(kCampaign, "trials = 3", "trials = 3\nimages_of_first_seed = true"))
                  .images_of_first_seed);
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
}

TEST_F(LoadCampaign, LaysItsProfileOnTopOfTheScenarios) {
  const auto file = scratch_.write("top.toml", replaced(kRigProfile, "\"rig\"", "\"top\""));
  const Campaign campaign =
      load(replaced(kCampaign, "paper_table", "profile = \"top.toml\"\npaper_table"));
  const CampaignScenario& entry = campaign.scenarios[0];
  EXPECT_EQ(entry.profile, file);
  EXPECT_THAT(entry.scenario.files, testing::Contains(file));
  EXPECT_THAT(profile_names(entry.scenario, *entry.scenario.find_condition("scripted")),
              ElementsAre("rig", "fog", "top"));
  EXPECT_TRUE(load(kCampaign).scenarios[0].profile.empty());
  EXPECT_THAT(error_with("paper_table", "profile = \"none.toml\"\npaper_table"),
              HasSubstr("campaign.toml:9: 'profile' of [scenario] names \"none.toml\""));
}

TEST_F(LoadCampaign, RefusesWhatCannotBeRun) {
  EXPECT_THAT(error_with("trials = 3", "trials = 0"), HasSubstr("campaign.toml:3: 'trials'"));
  EXPECT_THAT(error_with("trials = 3", "trials = 3\nseeds = [1]"), HasSubstr("either 'trials'"));
  EXPECT_THAT(error_with("trials = 3\nfirst_seed = 11", "seeds = [1, 1]"), HasSubstr("twice"));
  EXPECT_THAT(error_with("trials = 3\nfirst_seed = 11", "seeds = []"), HasSubstr("empty"));
  EXPECT_THAT(error_with("trials = 3\nfirst_seed = 11", "seeds = [-1]"), HasSubstr("at least 0"));
  EXPECT_THAT(error_with("trials = 3", "seeds = [1]"), HasSubstr("goes with 'trials'"));
  EXPECT_THAT(error_with("\"host\"", "\"hots\""), HasSubstr("did you mean 'host'?"));
  EXPECT_THAT(error_with(", \"host\"", ", \"target, no sync\""), HasSubstr("twice"));
  EXPECT_THAT(error_with("\"III\"", "\"3\""), HasSubstr("Allowed: 'I', 'II', 'III', 'IV' and 'V'"));
  EXPECT_THAT(error_with("\"scenario.toml\"", "\"none.toml\""), HasSubstr("no such file"));
}

TEST_F(LoadCampaign, RefusesOneScenarioTwice) {
  EXPECT_THAT(
      bad_file_message([&] { load(kCampaign + "\n[[scenario]]\nfile = \"scenario.toml\"\n"); }),
      HasSubstr("campaign.toml:12: 'file' of [scenario] is a second scenario"));
}

TEST_F(LoadCampaign, NamesTheScenarioWhoseContentIsWrong) {
  write_project(scratch_, replaced(kFullScenario, "step_ms = 2", "step_ms = 0"));
  EXPECT_THAT(bad_file_message([&] { load(kCampaign); }), HasSubstr("scenario.toml:4: 'step_ms'"));
}

}  // namespace
}  // namespace tether::scenario
