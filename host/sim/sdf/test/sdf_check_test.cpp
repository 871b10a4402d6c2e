#include "sdf_folder.h"

#include <ostream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// What Tether does not represent is named, each with file and line, and the rest is loaded.
namespace tether::sim {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

struct Unrepresented {
  const char* name;
  std::string text;
  const char* where;
  const char* message;
};

std::ostream& operator<<(std::ostream& out, const Unrepresented& given) {
  return out << given.name;
}

class SdfWarnings : public ::testing::TestWithParam<Unrepresented> {};

TEST_P(SdfWarnings, NamesTheElement) {
  const ScratchFolder folder;
  const auto warnings = load({folder.write("w.sdf", GetParam().text), {}, {}}).warnings;
  EXPECT_THAT(warnings,
              ElementsAre(AllOf(HasSubstr(GetParam().where), HasSubstr(GetParam().message))));
}

const std::string kSphere = "<geometry><sphere><radius>1</radius></sphere></geometry>";

const Unrepresented kUnrepresented[] = {
    {"unknown_element", world_sdf("\n<bogus>3</bogus>"),
     "w.sdf:4: ", "<bogus> of world 'w' is not represented"},
    {"unknown_tether_element", link_sdf("\n<tether:magic/>"),
     "w.sdf:6: ", "<tether:magic> of link 'l' is no element of Tether's in a <link>"},
    {"multirotor_in_the_world",
     world_sdf("<model name='m'><link name='l'/>\n<tether:multirotor/></model>"),
     "w.sdf:4: ", "UAVs are placed by the scenario"},
    {"joint",
     world_sdf("<model name='m'><link name='a'/><link name='b'/>\n"
               "<joint name='hinge' type='revolute'><parent>a</parent><child>b</child>"
               "<axis><xyz>0 0 1</xyz></axis></joint></model>"),
     "w.sdf:4: ", "joint 'hinge' is not represented"},
    {"plugin", world_sdf("<plugin name='wind' filename='libWind.so'/>"),
     "w.sdf:3: ", "plugin 'wind' is not represented"},
    {"actor", world_sdf("<actor name='walker'><skin><filename>a.dae</filename></skin></actor>"),
     "w.sdf:3: ", "actor 'walker' is not represented"},
    {"wind", world_sdf("<wind><linear_velocity>1 0 0</linear_velocity></wind>"),
     "w.sdf:3: ", "<wind> of world 'w'"},
    {"fog", world_sdf("<scene>\n<fog><type>linear</type></fog></scene>"), "w.sdf:4: ", "<fog>"},
    {"engine_settings", world_sdf("<physics name='p' type='ode'><ode/></physics>"),
     "w.sdf:3: ", "<ode> of physics 'p'"},
    {"heightmap",
     link_sdf("<visual name='v'><geometry><heightmap><uri>h.png</uri></heightmap>"
              "</geometry></visual>"),
     "w.sdf:5: ", "<heightmap> of visual 'v' is a shape that is not represented"},
    {"polyline",
     link_sdf("<visual name='v'><geometry><polyline><point>0 0</point><point>1 0</point>"
              "<point>0 1</point><height>1</height></polyline></geometry></visual>"),
     "w.sdf:5: ", "<polyline>"},
    {"material_script",
     link_sdf("<visual name='v'>" + kSphere +
              "<material>\n<script><uri>a</uri><name>Gazebo/Blue</name></script>"
              "</material></visual>"),
     "w.sdf:6: ", "<script> of visual 'v'"},
    {"normal_map",
     link_sdf("<visual name='v'>" + kSphere +
              "<material><pbr><metal><normal_map>n.png</normal_map></metal></pbr>"
              "</material></visual>"),
     "w.sdf:5: ", "<normal_map>"},
    {"sensor_in_the_world", link_sdf("<sensor name='s' type='imu'/>"),
     "w.sdf:5: ", "sensor 's' belongs to no UAV"},
    {"light_on_a_dynamic_model",
     world_sdf("<model name='m'><link name='l'>\n<light name='lamp' type='point'/></link></model>"),
     "w.sdf:4: ", "light 'lamp' is on a dynamic model"},
    {"range_of_a_light",
     world_sdf("<light name='lamp' type='point'><attenuation>\n<range>20</range></attenuation>"
               "</light>"),
     "w.sdf:4: ", "<range> of light 'lamp' is not represented"},
    {"inner_angle_of_a_spot",
     world_sdf("<light name='lamp' type='spot'><spot><outer_angle>0.8</outer_angle>\n"
               "<inner_angle>0.2</inner_angle><falloff>1</falloff></spot></light>"),
     "w.sdf:4: ", "<inner_angle> of light 'lamp' is not represented"},
    {"unknown_attribute", world_sdf("<model name='m'>\n<link name='l' colour='red'/></model>"),
     "w.sdf:4: ", "Attribute[colour] in element[link] not defined in SDF"},
    {"nested_in_a_dynamic_model",
     world_sdf(
         "<model name='m'><link name='l'/>\n<model name='n'><link name='l'/></model></model>"),
     "w.sdf:4: ", "moves on its own"},
};

INSTANTIATE_TEST_SUITE_P(Worlds, SdfWarnings, ::testing::ValuesIn(kUnrepresented),
                         [](const auto& given) { return given.param.name; });

TEST(SdfWarning, ElementsWithoutEffectAreSilent) {
  const ScratchFolder folder;
  const auto file = folder.write("w.sdf", world_sdf(R"(
      <gui><camera name='c'/></gui>
      <plugin name='tether' filename='libtether_gazebo.so'/>
      <scene><grid>false</grid><origin_visual>false</origin_visual></scene>
      <physics name='p' type='ode'><real_time_update_rate>0</real_time_update_rate></physics>)"));
  EXPECT_THAT(load({file, {}, {}}).warnings, IsEmpty());
}

TEST(SdfWarning, LightsThatLookAlikeEverywhereAreSilent) {
  const ScratchFolder folder;
  const auto file = folder.write("w.sdf", world_sdf(R"(
      <light name='endless' type='point'><attenuation><range>1000</range></attenuation></light>
      <light name='sun' type='directional'><attenuation><range>20</range></attenuation></light>
      <light name='even' type='spot'><spot><inner_angle>0.2</inner_angle>
        <outer_angle>0.8</outer_angle><falloff>0</falloff></spot></light>
      <light name='soft' type='spot'><spot><inner_angle>0</inner_angle>
        <outer_angle>0.8</outer_angle><falloff>1</falloff></spot></light>
      <light name='bulb' type='point'><spot><inner_angle>0.2</inner_angle>
        <outer_angle>0.8</outer_angle><falloff>1</falloff></spot></light>)"));
  EXPECT_THAT(load({file, {}, {}}).warnings, IsEmpty());
}

TEST(SdfWarning, EveryElementIsNamedAndTheRestLoads) {
  const ScratchFolder folder;
  const auto file = folder.write("w.sdf", link_sdf(R"(
      <visual name='a'><geometry><heightmap><uri>h.png</uri></heightmap></geometry></visual>
      <visual name='b'><geometry><sphere><radius>1</radius></sphere></geometry>
        <laser_retro>1</laser_retro></visual>
      <enable_wind>true</enable_wind>)"));
  const auto loaded = load({file, {}, {}});
  EXPECT_EQ(loaded.warnings.size(), 3u);
  EXPECT_THAT(loaded.warnings, Contains(HasSubstr("<laser_retro> of visual 'b'")));
  ASSERT_EQ(loaded.world.models.at(0).links.at(0).visuals.size(), 1u);
  EXPECT_EQ(loaded.world.models[0].links[0].visuals[0].name, "b");
}

TEST(SdfWarning, OfLibsdformatsConsoleIsPassedOn) {
  const ScratchFolder folder;
  const auto file = folder.write("w.sdf", world_sdf(R"(
      <model name='a'><static>true</static><link name='l'/></model>
      <light name='a' type='point'/>)"));
  EXPECT_THAT(load({file, {}, {}}).warnings,
              Contains(file.string() + ": Non-unique name[a] detected 2 times in XML children of "
                                       "world with name[w]"));
}

TEST(SdfWarning, IsOnePrintableLineWhateverTheName) {
  const ScratchFolder folder;
  const auto file = folder.write("w.sdf", link_sdf("<projector name='a&#10;b&#27;[2J'/>"));
  EXPECT_THAT(load({file, {}, {}}).warnings,
              ::testing::ElementsAre(HasSubstr("projector 'a?b?[2J'")));
}

TEST(SdfWarning, NoSinkIsNoError) {
  const ScratchFolder folder;
  EXPECT_EQ(refusal({folder.write("w.sdf", world_sdf("<bogus/>")), {}, {}}), "");
}

}  // namespace
}  // namespace tether::sim
