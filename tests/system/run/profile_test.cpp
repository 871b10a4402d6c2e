#include "support/trials.h"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// Profiles from the command line and from a campaign.
namespace tether::system_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::filesystem::path source(const std::string& file) {
  return std::filesystem::path(TETHER_SOURCE_DIR) / "data" / file;
}

/// The shipped scenario under a scripted clock, with few images.
std::filesystem::path write_characterization(const std::filesystem::path& folder) {
  return write_shipped_scenario(folder, "sensor_characterization",
                                {scripted_host(1), {"acquisitions = 100", "acquisitions = 5"}});
}

/// The mean time of an acquisition under that profile [ms], and the profiles that were in use.
struct Characterized {
  double acquisition_time_ms = -1.0;
  std::vector<std::string> profiles;
};

Characterized characterize(const std::string& profile) {
  const TempFolder folder;
  const auto out = folder / "out";
  const Output output =
      run(tether({"run", write_characterization(folder.path()), "--quiet", "--condition", "host",
                  "--profile", source(profile).string(), "--out", out.string()}));
  EXPECT_EQ(output.code, 0) << output.err;
  EXPECT_EQ(output.err, "");
  const auto result = read_result(out);
  EXPECT_TRUE(result["audit"]["passed"]) << result["audit"]["summary"];
  Characterized characterized{.profiles = result["profiles"]};
  for (const auto& metric : result["metrics"]) {
    if (metric["name"] == "camera_acquisition_time") {
      characterized.acquisition_time_ms = metric["value"];
    }
  }
  return characterized;
}

TEST(Profile, IdealSensorsCostNothing) {
  const Characterized found = characterize("profiles/ideal.toml");
  EXPECT_EQ(found.acquisition_time_ms, 0.0);
  EXPECT_THAT(found.profiles, ElementsAre("paper_table_1", "ideal"));
}

TEST(Profile, SensorsOfThePapersTableICostItsMean) {
  const Characterized found = characterize("profiles/paper_table_1.toml");
  EXPECT_NEAR(found.acquisition_time_ms, 37.4, 1e-6);
  EXPECT_THAT(found.profiles, ElementsAre("paper_table_1")) << "the scenario's own, laid on top";
}

TEST(Profile, ThatIsWrongIsRefusedAndLeavesNothing) {
  const TempFolder folder;
  const auto scenario = write_hover_scenario(folder.path(), "good");
  const auto profile = folder / "bad.toml";
  const auto refused_at = [&](const std::string& text, const std::string& at) {
    write_text(profile, text);
    const Output output =
        run(tether({"run", scenario, "--profile", profile.string(), "--out", folder / "out"}));
    EXPECT_EQ(output.code, 2) << output.err;
    EXPECT_THAT(output.err, testing::StartsWith("tether: " + folder.path().string() + "/" + at));
    EXPECT_EQ(std::count(output.err.begin(), output.err.end(), '\n'), 1) << output.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "out"));
  };
  const std::string range = "name = \"bad\"\n[sensors.range]\nkind = \"range\"\n";
  refused_at(range + "delay = { kind = \"constant\", ms = -1 }\n", "bad.toml:4: ");
  refused_at(range + "exposure_ms = 3\n", "bad.toml:4: ");
  refused_at(range + "min_m = 4\n", "bad.toml:4: ");
  write_text(folder / "delays.txt", "1.5\nsoon\n");
  refused_at(range + "delay = { kind = \"empirical\", file_ms = \"delays.txt\" }\n",
             "delays.txt:2: ");
  write_text(folder / "delays.txt", "");
  refused_at(range + "delay = { kind = \"empirical\", file_ms = \"delays.txt\" }\n",
             "delays.txt: ");
}

TEST(Profile, ThatMeansNothingToTheUavIsWarnedOf) {
  const TempFolder folder;
  const auto scenario = write_hover_scenario(folder.path(), "good");
  write_text(folder / "second.toml",
             "name = \"second\"\n[sensors.camera]\nkind = \"camera\"\n"
             "[sensors.camera2]\nkind = \"camera\"\n");
  const Output output = run(tether(
      {"run", scenario, "--quiet", "--profile", folder / "second.toml", "--out", folder / "out"}));
  EXPECT_EQ(output.code, 0) << output.err;
  EXPECT_THAT(output.err, HasSubstr((folder / "second.toml").string() + ":4: "));
  EXPECT_THAT(output.err, HasSubstr("[sensors.camera2]"));
}

// What judges a run (the true ROI of metrics and reports) is made of the record's camera, so that
// must be the one that gave the images.
TEST(Profile, TheRecordHoldsTheCameraAsTheProfileMadeIt) {
  const TempFolder folder;
  const auto scenario = write_hover_scenario(folder.path(), "good");
  write_text(folder / "lens.toml",
             "name = \"lens\"\n[sensors.camera]\nkind = \"camera\"\nposition_m = [0.5, 0, 0.25]\n"
             "rpy_deg = [0, 0, 90]\nsize_px = [320, 200]\nhorizontal_fov_deg = 90\n"
             "distortion = { k1 = -0.125 }\n");
  const Output output = run(tether(
      {"run", scenario, "--quiet", "--profile", folder / "lens.toml", "--out", folder / "out"}));
  ASSERT_EQ(output.code, 0) << output.err;
  const auto sensors = read_record(folder / "out").header.sensors;
  const auto found = std::find_if(sensors.begin(), sensors.end(),
                                  [](const auto& sensor) { return sensor.name == "camera"; });
  ASSERT_NE(found, sensors.end());
  ASSERT_TRUE(found->camera);
  EXPECT_THAT(found->camera->p_BS_m, ElementsAre(0.5, 0.0, 0.25));
  EXPECT_NEAR(found->camera->q_BS[3], std::sqrt(0.5), 1e-12);
  EXPECT_EQ(found->camera->width_px, 320);
  EXPECT_EQ(found->camera->height_px, 200);
  EXPECT_NEAR(found->camera->fx_px, 160.0, 1e-9);
  EXPECT_EQ(found->camera->k1, -0.125);
}

/// A campaign whose scenario has a profile laid on top.
class ProfileOfACampaign : public testing::Test {
 protected:
  ProfileOfACampaign() {
    write_hover_scenario(folder_.path(), "good");
    write_profile(1);
    write_campaign("profile = \"late.toml\"\n");
  }
  void write_profile(int delay_ms) const {
    write_text(folder_ / "late.toml",
               "name = \"late\"\n[sensors.range]\nkind = \"range\"\ndelay = { kind = \"constant\", "
               "ms = " +
                   std::to_string(delay_ms) + " }\n");
  }
  void write_campaign(const std::string& profile) const {
    write_text(folder_ / "campaign.toml",
               "name = \"small\"\ntrials = 1\n\n[[scenario]]\nfile = \"hover.toml\"\n"
               "conditions = [\"host\"]\n" +
                   profile);
  }
  Output campaign(const std::vector<std::string>& options = {}) const {
    std::vector<std::string> words = {"campaign", folder_ / "campaign.toml", "--out",
                                      folder_ / "out"};
    words.insert(words.end(), options.begin(), options.end());
    return run(tether(words));
  }
  void expect_refused(const std::string& why) const {
    const Output output = campaign({"--resume"});
    EXPECT_EQ(output.code, 2);
    EXPECT_THAT(output.err, HasSubstr(why));
    EXPECT_EQ(std::count(output.err.begin(), output.err.end(), '\n'), 1) << output.err;
  }
  TempFolder folder_;
};

TEST_F(ProfileOfACampaign, IsInUseInEachTrial) {
  const Output output = campaign();
  ASSERT_EQ(output.code, 0) << output.err;
  const auto trial = folder_ / "out" / "hover/host/seed-0001";
  EXPECT_THAT(read_result(trial)["profiles"], ElementsAre("late"));
  const auto sensors = read_record(trial).header.sensors;
  const auto range = std::find_if(sensors.begin(), sensors.end(),
                                  [](const auto& sensor) { return sensor.name == "range"; });
  ASSERT_NE(range, sensors.end());
  EXPECT_EQ(range->delay_max, std::chrono::milliseconds(1));
}

TEST_F(ProfileOfACampaign, MustBeTheSameToResume) {
  ASSERT_EQ(campaign().code, 0);
  EXPECT_EQ(campaign({"--resume"}).code, 0);
  write_profile(2);
  expect_refused("late.toml");
  write_profile(1);
  write_campaign("");
  expect_refused("late.toml");
}

TEST_F(ProfileOfACampaign, ThatIsWrongIsRefusedAndLeavesNothing) {
  write_text(folder_ / "late.toml",
             "name = \"late\"\n[sensors.range]\nkind = \"range\"\nmax_m = 0.01\n");
  const Output output = campaign();
  EXPECT_EQ(output.code, 2) << output.err;
  EXPECT_THAT(output.err, HasSubstr("late.toml:4: "));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
}

}  // namespace
}  // namespace tether::system_test
