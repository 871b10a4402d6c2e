#include "support/trials.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// Profiles from the command line and from a campaign.
namespace tether::system_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::filesystem::path source(const std::string& file) {
  return std::filesystem::path(TETHER_SOURCE_DIR) / file;
}

/// The shipped scenario under a scripted clock, with few images.
std::filesystem::path write_characterization(const std::filesystem::path& folder) {
  return write_shipped_scenario(folder, "sensor_characterization",
                                {scripted_host(1), {"acquisitions = 100", "acquisitions = 5"}});
}

/// The mean time of an acquisition under that profile [ms].
double acquisition_time_ms(const std::string& profile) {
  const TempFolder folder;
  const auto out = folder / "out";
  const Output output =
      run(tether({"run", write_characterization(folder.path()), "--quiet", "--condition", "host",
                  "--profile", source(profile).string(), "--out", out.string()}));
  EXPECT_EQ(output.code, 0) << output.err;
  EXPECT_EQ(output.err, "");
  const auto result = read_result(out);
  EXPECT_TRUE(result["audit"]["passed"]) << result["audit"]["summary"];
  EXPECT_THAT(result["profiles"],
              ElementsAre("paper_table_1", std::filesystem::path(profile).stem().string()));
  for (const auto& metric : result["metrics"])
    if (metric["name"] == "camera_acquisition_time") return metric["value"].get<double>();
  return -1.0;
}

TEST(Profile, IdealSensorsCostNothing) {
  EXPECT_EQ(acquisition_time_ms("profiles/ideal.toml"), 0.0);
}

TEST(Profile, SensorsOfThePapersTableICostItsMean) {
  EXPECT_NEAR(acquisition_time_ms("profiles/paper_table_1.toml"), 37.4, 1e-6);
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
  EXPECT_THAT(output.err, HasSubstr("warning: " + (folder / "second.toml").string() +
                                    ":4: the UAV "
                                    "'uav1' has no sensor of the kind \"camera\" for "
                                    "[sensors.camera2]"));
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
  for (const auto& sensor : read_record(trial).header.sensors) {
    if (sensor.name != "range") continue;
    EXPECT_EQ(sensor.delay_max, std::chrono::milliseconds(1));
  }
}

TEST_F(ProfileOfACampaign, MustBeTheSameToResume) {
  ASSERT_EQ(campaign().code, 0);
  EXPECT_EQ(campaign({"--resume"}).code, 0);
  write_profile(2);
  expect_refused("'file late.toml' was");
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
