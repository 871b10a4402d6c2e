#include "test_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/scenario/profile.h>

namespace tether::scenario {
namespace {

using testing::ElementsAre;
using testing::Key;

class LoadProfile : public testing::Test {
 protected:
  Profile load(const std::string& text) const {
    return load_profile(scratch_.write("rigs/p.toml", text));
  }
  ScratchFolder scratch_;
};

TEST_F(LoadProfile, ReadsTheTopAndFindsItsSamplesBesideItself) {
  const auto samples = scratch_.write("rigs/camera.txt", "33\n35\n");
  const Profile profile =
      load(replaced(kFullProfile, "samples_ms = [33.1, 33.4]", "file_ms = \"camera.txt\""));
  EXPECT_EQ(profile.name, "rig");
  EXPECT_EQ(profile.description, "every key");
  EXPECT_EQ(profile.file, scratch_.path("rigs/p.toml"));
  EXPECT_THAT(profile.sensors, ElementsAre(Key("camera"), Key("imu"), Key("range")));
  EXPECT_THAT(profile.files, ElementsAre(profile.file, samples));
  EXPECT_THAT(std::get<uav::EmpiricalDelay>(*profile.sensors.at("camera").delay).samples,
              ElementsAre(std::chrono::milliseconds(33), std::chrono::milliseconds(35)));
}

TEST_F(LoadProfile, RefusesWhatIsNoProfile) {
  expect_refusal(0, "name", [&] { load(""); });
  expect_refusal(0, "sensors", [&] { load("name = \"x\"\n"); });
  expect_refusal(2, "sensors", [&] { load("name = \"x\"\n[sensors]\n"); });
  expect_refusal(3, "camera", [&] { load("name = \"x\"\n[sensors]\ncamera = 3\n"); });
  expect_refusal(3, "kind", [&] { load("name = \"x\"\n[sensors.a]\nkind = \"sonar\"\n"); });
}

}  // namespace
}  // namespace tether::scenario
