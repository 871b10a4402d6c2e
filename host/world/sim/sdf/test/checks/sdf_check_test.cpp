#include "sdf_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// What Tether does not represent is named, each with file and line, and the rest is loaded.
namespace tether::sim {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::IsEmpty;

struct Unrepresented {
  std::string text;
  int line;
  const char* element;
  Consequence consequence;
  bool can_change_verdict;
};

std::string link(const std::string& content) {
  return "<model name='m'><static>true</static>\n<link name='l'>\n" + content + "\n</link></model>";
}
std::string visual_of(const std::string& content) {
  return link("<visual name='v'>" + content + "</visual>");
}
const std::string kSphere = "<geometry><sphere><radius>1</radius></sphere></geometry>";

TEST(SdfWarning, NamesTheElement) {
  const Unrepresented cases[] = {
      {"\n<bogus>3</bogus>", 4, "<bogus> of world 'w'", Consequence::kBehavesDifferent, true},
      {link("\n<tether:magic/>"), 6, "<tether:magic> of link 'l'", Consequence::kNoEffect, true},
      {"<model name='m'><link name='l'/>\n<tether:multirotor/></model>", 4,
       "<tether:multirotor> of model 'm'", Consequence::kNoEffect, false},
      {"<model name='m'><link name='a'/><link name='b'/>\n"
       "<joint name='hinge' type='revolute'><parent>a</parent><child>b</child>"
       "<axis><xyz>0 0 1</xyz></axis></joint></model>",
       4, "joint 'hinge'", Consequence::kBehavesDifferent, true},
      {"<plugin name='wind' filename='libWind.so'/>", 3, "plugin 'wind'",
       Consequence::kBehavesDifferent, true},
      {"<actor name='walker'><skin><filename>a.dae</filename></skin></actor>", 3, "actor 'walker'",
       Consequence::kMissing, true},
      {"<scene>\n<fog><type>linear</type></fog></scene>", 4, "<fog> of world 'w'",
       Consequence::kLooksDifferent, true},
      {"<physics name='p' type='ode'><ode/></physics>", 3, "<ode> of physics 'p'",
       Consequence::kNoEffect, false},
      {visual_of("<geometry><heightmap><uri>h.png</uri></heightmap></geometry>"), 5,
       "<heightmap> of visual 'v'", Consequence::kMissing, true},
      {visual_of("<geometry><image><uri>h.png</uri></image></geometry>"), 5,
       "<image> of visual 'v'", Consequence::kMissing, true},
      {visual_of(kSphere + "<material>\n<script><uri>a</uri><name>No/Such</name></script>"
                           "</material>"),
       6, "<script> of visual 'v'", Consequence::kLooksDifferent, true},
      {visual_of(kSphere + "<material><script><name>No/Such</name></script></material>"), 5,
       "<script> of visual 'v'", Consequence::kLooksDifferent, true},
      {visual_of(kSphere + "<material><pbr><metal><normal_map>n.png</normal_map></metal></pbr>"
                           "</material>"),
       5, "<normal_map> of visual 'v'", Consequence::kLooksDifferent, false},
      {link("<sensor name='s' type='imu'/>"), 5, "sensor 's'", Consequence::kNoEffect, false},
      {"<model name='m'><link name='l'>\n<light name='lamp' type='point'/></link></model>", 4,
       "light 'lamp'", Consequence::kLooksDifferent, false},
      {"<light name='lamp' type='point'><attenuation>\n<range>20</range></attenuation></light>", 4,
       "<range> of light 'lamp'", Consequence::kLooksDifferent, false},
      {"<light name='lamp' type='spot'><spot><outer_angle>0.8</outer_angle>\n"
       "<inner_angle>0.2</inner_angle><falloff>1</falloff></spot></light>",
       4, "<inner_angle> of light 'lamp'", Consequence::kLooksDifferent, false},
      {"<model name='m'>\n<link name='l' colour='red'/></model>", 4, "attribute colour",
       Consequence::kNoEffect, false},
      {"<model name='m'><link name='l'/>\n<model name='n'><link name='l'/></model></model>", 4,
       "model 'n'", Consequence::kBehavesDifferent, true},
  };
  const ScratchFolder folder;
  for (const Unrepresented& given : cases) {
    const auto file = folder.write("w.sdf", world_sdf(given.text));
    EXPECT_THAT(load({file, {}, {}}).warnings,
                ElementsAre(AllOf(is_warning(given.consequence, file, given.line, given.element),
                                  Field(&Warning::can_change_verdict, given.can_change_verdict))));
  }
}

std::string model_of(const std::string& content) {
  return "<model name='m'><link name='l'>" + content + "</link></model>";
}

TEST(SdfWarning, ChangesNoVerdictForWhatHoldsAnyway) {
  for (const std::string& content : {
           link("<gravity>false</gravity>"),
           link("<enable_wind>true</enable_wind>"),
           std::string("<plugin name='p' filename='gz-sim-physics-system'/>"),
           std::string("<plugin name='p' filename='libignition-gazebo6-sensors-system.so'/>"),
           std::string("<plugin name='p' filename='/opt/ros/lib/libgazebo_ros_init.so'/>"),
       })
    EXPECT_THAT(load_content(content).warnings,
                ElementsAre(Field(&Warning::can_change_verdict, false)))
        << content;
}

TEST(SdfWarning, CanChangeAVerdictForWhatMovesSomething) {
  for (const std::string& content : {
           model_of("<gravity>false</gravity>"),
           model_of("<enable_wind>true</enable_wind>"),
           model_of("<velocity_decay><linear>0.5</linear></velocity_decay>"),
           std::string(
               "<model name='m'><static>true</static><link name='l'><collision name='c'>"
               "<geometry><box><size>1 1 1</size></box></geometry><surface><contact>"
               "<category_bitmask>0</category_bitmask></contact></surface></collision></link>"
               "</model>"),
           std::string("<plugin name='p' filename='libmoving_platform.so'/>"),
           std::string("<plugin name='p' filename='gz-sim-wind-effects-system'/>"),
           std::string("<plugin name='p' filename='gz-sim-'/>"),
           std::string("<plugin name='p' filename='-system'/>"),
       })
    EXPECT_THAT(load_content(content).warnings,
                ElementsAre(Field(&Warning::can_change_verdict, true)))
        << content;
}

TEST(SdfWarning, IsNotGivenForWhatHoldsAnyway) {
  for (const char* content :
       {"<gravity>1</gravity>", "<self_collide>0</self_collide>", "<kinematic>false</kinematic>",
        "<velocity_decay/>", "<velocity_decay><linear>0.0</linear></velocity_decay>"})
    EXPECT_THAT(load_content(model_of(content)).warnings, IsEmpty()) << content;
}

TEST(SdfWarning, IsNotGivenForElementsWithoutEffect) {
  EXPECT_THAT(load_content(R"(
      <gui><camera name='c'/></gui>
      <plugin name='tether' filename='libtether_gazebo.so'/>
      <scene><grid>false</grid><origin_visual>false</origin_visual></scene>
      <physics name='p' type='ode'><real_time_update_rate>0</real_time_update_rate></physics>)")
                  .warnings,
              IsEmpty());
}

TEST(SdfWarning, IsNotGivenForLightsThatAllSimulatorsShowAlike) {
  EXPECT_THAT(load_content(R"(
      <light name='endless' type='point'><attenuation><range>1000</range></attenuation></light>
      <light name='sun' type='directional'><attenuation><range>20</range></attenuation></light>
      <light name='even' type='spot'><spot><inner_angle>0.2</inner_angle>
        <outer_angle>0.8</outer_angle><falloff>0</falloff></spot></light>
      <light name='soft' type='spot'><spot><inner_angle>0</inner_angle>
        <outer_angle>0.8</outer_angle><falloff>1</falloff></spot></light>
      <light name='bulb' type='point'><spot><inner_angle>0.2</inner_angle>
        <outer_angle>0.8</outer_angle><falloff>1</falloff></spot></light>)")
                  .warnings,
              IsEmpty());
}

TEST(SdfWarning, NamesEveryElementAndLoadsTheRest) {
  const Loaded loaded = load_content(link(R"(
      <visual name='a'><geometry><heightmap><uri>h.png</uri></heightmap></geometry></visual>
      <visual name='b'><geometry><sphere><radius>1</radius></sphere></geometry>
        <visibility_flags>1</visibility_flags></visual>
      <enable_wind>true</enable_wind>)"));
  EXPECT_EQ(loaded.warnings.size(), 3u);
  EXPECT_THAT(loaded.warnings,
              Contains(Field("subject", &Warning::subject, "<visibility_flags> of visual 'b'")));
  ASSERT_EQ(loaded.world.models.at(0).links.at(0).visuals.size(), 1u);
  EXPECT_EQ(loaded.world.models[0].links[0].visuals[0].name, "b");
}

TEST(SdfWarning, IsOnePrintableLine) {
  EXPECT_THAT(load_content(link("<projector name='a&#10;b&#27;[2J'/>")).warnings,
              ElementsAre(Field("subject", &Warning::subject, "projector 'a?b?[2J'")));
}

TEST(SdfWarning, NeedsNoSink) {
  const ScratchFolder folder;
  load_world({folder.write("w.sdf", world_sdf("<bogus/>")), {}, {}}, nullptr);
}

}  // namespace
}  // namespace tether::sim
