#include "full_profile.h"
#include "full_scenario.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/scenario/profile.h>

namespace tether::scenario {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Key;

class LoadProfile : public testing::Test {
 protected:
  Profile load(const std::string& text) const {
    return load_profile(scratch_.write("rigs/p.toml", text));
  }
  std::string error_of(const std::string& text) const {
    return bad_file_message([&] { load(text); });
  }
  ScratchFolder scratch_;
};

TEST_F(LoadProfile, ReadsTheTop) {
  const Profile profile = load(kFullProfile);
  EXPECT_EQ(profile.name, "rig");
  EXPECT_EQ(profile.description, "every key");
  EXPECT_EQ(profile.file, scratch_.path("rigs/p.toml"));
  EXPECT_THAT(profile.sensors, ElementsAre(Key("camera"), Key("imu"), Key("range")));
  EXPECT_THAT(profile.files, ElementsAre(profile.file));
  EXPECT_EQ(load("name = \"x\"\n[sensors.a]\nkind = \"imu\"\n").description, "");
}

TEST_F(LoadProfile, FindsItsSamplesBesideItselfAndListsThem) {
  const auto samples = scratch_.write("rigs/camera.txt", "33\n35\n");
  const Profile profile =
      load(replaced(kFullProfile, "samples_ms = [33.1, 33.4]", "file_ms = \"camera.txt\""));
  EXPECT_THAT(profile.files, ElementsAre(profile.file, samples));
  EXPECT_THAT(std::get<uav::EmpiricalDelay>(*profile.sensors.at("camera").delay).samples,
              ElementsAre(std::chrono::milliseconds(33), std::chrono::milliseconds(35)));
}

TEST_F(LoadProfile, RefusesWhatIsNoProfile) {
  EXPECT_THAT(error_of(""), HasSubstr("p.toml: the file lacks the key 'name'"));
  EXPECT_THAT(error_of("name = \"a b\"\n[sensors.a]\nkind = \"imu\"\n"),
              HasSubstr("p.toml:1: 'name' of the file must be 1 to 64 letters"));
  EXPECT_THAT(error_of("name = \"x\"\n"), HasSubstr("lacks the key 'sensors'"));
  EXPECT_THAT(error_of("name = \"x\"\n[sensors]\n"),
              HasSubstr("p.toml:2: 'sensors' of the file names no sensor"));
  EXPECT_THAT(error_of("name = \"x\"\nsensors = 3\n"), HasSubstr("p.toml:2: 'sensors' of"));
  EXPECT_THAT(error_of("name = \"x\"\n[sensors]\ncamera = 3\n"),
              HasSubstr("p.toml:3: 'camera' of [sensors] must be a table"));
  EXPECT_THAT(error_of("name = \"x\"\n[sensors.a]\nkind = \"sonar\"\n"),
              HasSubstr("p.toml:3: 'kind' of [sensors.a] is \"sonar\"; Allowed: 'camera', "
                        "'imu' and 'range'"));
  EXPECT_THAT(bad_file_message([&] { load_profile(scratch_.path("none.toml")); }),
              HasSubstr("none.toml: there is no such file"));
}

}  // namespace
}  // namespace tether::scenario
