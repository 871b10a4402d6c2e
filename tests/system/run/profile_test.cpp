#include "support/trials.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// Profiles from the command line and from a campaign. How layers are merged and what is refused:
/// host/plan/scenario/test. What a profile's delay costs: acquisition_test.cpp.
namespace tether::system_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

// Metrics and reports take the true ROI from the record's camera, so that must be the one that gave
// the images. What means nothing to the UAV is warned of.
TEST(Profile, ChangesTheCameraOfTheRecord) {
  const TempFolder folder;
  const auto profile = folder / "lens.toml";
  write_text(profile,
             "name = \"lens\"\n[sensors.camera]\nkind = \"camera\"\nposition_m = [0.5, 0, 0.25]\n"
             "size_px = [320, 200]\n[sensors.camera2]\nkind = \"camera\"\n");
  const Output output = run(tether({"run", write_hover_scenario(folder.path(), "good"), "--profile",
                                    profile, "--out", folder / "out"}));
  ASSERT_EQ(output.code, 0) << output.err;
  EXPECT_THAT(output.err, HasSubstr(profile.string() + ":6: "));
  const auto sensors = read_record(folder / "out").header.sensors;
  const auto camera = std::ranges::find(sensors, "camera", &record::SensorInfo::name);
  ASSERT_NE(camera, sensors.end());
  EXPECT_THAT(camera->camera->p_BS_m, ElementsAre(0.5, 0.0, 0.25));
  EXPECT_EQ(camera->camera->width_px, 320);
}

TEST(ProfileOfACampaign, IsInUseInEachTrialAndMustBeTheSameToResume) {
  const TempFolder folder;
  write_hover_scenario(folder.path(), "good");
  const auto campaign =
      write_campaign(folder.path(), 1, "conditions = [\"host\"]\nprofile = \"late.toml\"\n");
  const auto write_profile = [&](const std::string& delay_ms) {
    write_text(folder / "late.toml",
               "name = \"late\"\n[sensors.range]\nkind = \"range\"\n"
               "delay = { kind = \"constant\", ms = " +
                   delay_ms + " }\n");
  };
  const auto fly = [&](const std::vector<std::string>& options = {}) {
    return run(with(tether({"campaign", campaign, "--out", folder / "out"}), options));
  };
  write_profile("-1");
  const Output wrong = fly();
  EXPECT_EQ(wrong.code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("late.toml:4: "));
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));

  write_profile("1");
  const Output output = fly();
  ASSERT_EQ(output.code, 0) << output.err;
  const auto trial = folder / "out/hover/host/seed-0001";
  EXPECT_THAT(read_result(trial)["profiles"], ElementsAre("late"));
  for (const auto& sensor : read_record(trial).header.sensors) {
    if (sensor.name == "range") {
      EXPECT_EQ(sensor.delay_max, std::chrono::milliseconds(1));
    }
  }
  EXPECT_EQ(fly({"--resume"}).code, 0);
  write_profile("2");
  const Output changed = fly({"--resume"});
  EXPECT_EQ(changed.code, 2);
  EXPECT_THAT(changed.err, HasSubstr("late.toml"));
}

}  // namespace
}  // namespace tether::system_test
