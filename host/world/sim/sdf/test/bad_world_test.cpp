#include "sdf_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// Each way in which a world cannot be used: the place and subject of the error. Errors that
/// libsdformat finds have no subject; their message has the value or name that is wrong.
namespace tether::sim {
namespace {

using ::testing::HasSubstr;

struct BadWorld {
  std::string text;
  int line;
  std::string subject;
  std::string found{};
};

void expect_refused(const std::vector<BadWorld>& worlds) {
  const ScratchFolder folder;
  folder.write("m.ply", "ply");
  for (const BadWorld& bad : worlds) {
    SCOPED_TRACE(bad.text.substr(0, 300));
    const auto file = folder.write("w.sdf", bad.text);
    const Error error = refusal({file, {}, {}});
    expect_error(error, file, bad.line, bad.subject);
    EXPECT_THAT(error.what(), HasSubstr(bad.found));
  }
}

std::string moving(const std::string& content) {
  return world_sdf("<model name='m'><link name='l'>" + content + "</link></model>");
}
std::string visual(const std::string& geometry, const std::string& material = "") {
  return link_sdf("<visual name='v'>\n<geometry>" + geometry + "</geometry>\n" + material +
                  "</visual>");
}
std::string material(const std::string& content) {
  return visual("<sphere><radius>1</radius></sphere>", "<material>\n" + content + "</material>");
}

TEST(BadWorlds, FilesAreRefused) {
  // Longer than the stack allows for std::regex.
  const std::string long_name(1'000'000, 'a');
  expect_refused({
      {"<sdf version='1.7'>\n<world></sdf>", 2, ""},
      {"", 0, ""},
      {"<?xml version='1.0'?>\n<!-- nothing -->", 0, ""},
      {"<html>\n</html>", 1, "", "<html>"},
      {"<sdf version='1.x'>\n<world name='w'/></sdf>", 1, "<sdf>", "<sdf version='1."},
      {"<sdf version='1.7'>\n</sdf>", 0, "<world>", "0 <world>"},
      {"<sdf version='1.7'>\n<world name='a'/>\n<world name='b'/>\n</sdf>", 0, "<world>",
       "2 <world>"},
      {world_sdf("<model name='" + long_name +
                 "'><pose relative_to='zz'/><link name='l'/></model>"),
       0, "", "aaa"},
      {world_sdf("<model name='m'><link name='" + long_name +
                 "'>\n<gravity>perhaps</gravity></link></model>"),
       4, "", "'perhaps'"},
      {world_sdf("<model name='m'>\n<static>Yes</static><link name='l'/></model>"), 4, "",
       "'Yes' is not a value that SDF allows for it. Write true or false"},
      {world_sdf("<model name='a'><link name='l'/></model>\n"
                 "<model name='a'><link name='l'/></model>"),
       3, "", "name[a]"},
      {world_sdf("\n<model name='m'><pose relative_to='zz'>0 0 0 0 0 0</pose><link name='l'/>"
                 "</model>"),
       4, "", "zz"},
  });
}

TEST(BadWorlds, ValuesAreRefused) {
  expect_refused({
      {visual("<box><size>1 1 1</size></box>", "<pose relative_to='nowhere'>0 0 0 0 0 0</pose>"), 5,
       "visual 'v'", "relative to 'nowhere', which cannot be found"},
      {moving("<inertial>\n<mass>-2</mass></inertial>"), 4, "<mass> of link 'l'", "-2"},
      {moving("<inertial>\n<mass>nan</mass></inertial>"), 4, "<mass> of link 'l'", "finite"},
      {visual("<box><size>1 0 1</size></box>"), 6, "<size> of visual 'v'", "1 0 1"},
      {visual("<box><size>1e300 1 1</size></box>"), 6, "<size> of visual 'v'", "100000 m"},
      {link_sdf(
           "<visual name='v'><pose>0 0 nan 0 0 0</pose><geometry><empty/></geometry></visual>"),
       5, "", "<pose>"},
      {link_sdf("<pose>0 -1e6 0 0 0 0</pose>"), 5, "<pose> of link 'l'", "100000 m"},
      {world_sdf("<gravity>0 0 9.81</gravity>"), 3, "<gravity> of world 'w'"},
      {world_sdf("<physics name='p' type='ode'>\n<max_step_size>0</max_step_size></physics>"), 4,
       "<max_step_size> of physics 'p'", "0"},
      {world_sdf("<physics name='p' type='ode'>\n<max_step_size>1</max_step_size></physics>"), 4,
       "<max_step_size> of physics 'p'", "0.1 seconds"},
      {world_sdf("<light name='s' type='directional'><direction>0 0 0</direction></light>"), 3,
       "light 's'", "<direction>"},
      {world_sdf(
           "<light name='s' type='spot'><spot>\n<outer_angle>3.2</outer_angle></spot></light>"),
       4, "<outer_angle> of light 's'", "3.1416"},
      {world_sdf("<light name='s' type='point'>\n<intensity>1e7</intensity></light>"), 4,
       "<intensity> of light 's'", "1000000"},
      {visual("<plane><normal>0 0 0</normal><size>1 1</size></plane>"), 6, "<plane> of visual 'v'",
       "<normal>"},
  });
}

TEST(BadWorlds, NumbersAreRefusedUnlessComplete) {
  const std::string size = "<size> of visual 'v'", radius = "<radius> of visual 'v'";
  const std::string pose = "<pose> of link 'l'";
  expect_refused({
      {link_sdf("<inertial>\n<mass>heavy</mass></inertial>"), 6, "<mass> of link 'l'", "'heavy'"},
      {link_sdf("<inertial>\n<mass>1 kg</mass></inertial>"), 6, "<mass> of link 'l'", "kilograms"},
      {visual("<box>\n<size>1 1 1 m</size></box>"), 7, size, "metres"},
      {visual("<box><size>1 1</size></box>"), 6, size, "three numbers"},
      {visual("<box><size>1 1 1 1</size></box>"), 6, size, "three numbers"},
      {visual("<box><size>1e400 1 1</size></box>"), 6, size, "1e400"},
      {visual("<sphere><radius>2,5</radius></sphere>"), 6, radius, "'2,5'"},
      {visual("<sphere><radius/></sphere>"), 6, radius, "''"},
      {visual("<sphere><radius>2<!-- --> m</radius></sphere>"), 6, radius, "'2 m'"},
      {link_sdf("<pose>0 0 1 m 0 0 0</pose>"), 5, pose, "radians"},
      {link_sdf("<pose degrees='true'>0 0 1 0 0 90deg</pose>"), 5, pose, "degrees"},
      {link_sdf("<pose rotation_format='quat_xyzw'>0 0 1 0 0 0</pose>"), 5, pose, "seven numbers"},
      {link_sdf("<pose rotation_format='quat_xyzw'>0 0 1 0 0 0 0</pose>"), 5, pose,
       "a unit quaternion"},
      {link_sdf("<pose rotation_format='quat_xyzw'>0 0 1 0 0 0.7 0.8</pose>"), 5, pose,
       "'0 0 1 0 0 0.7 0.8'"},
      {world_sdf("<include>\n<pose>1m 0 0 0 0 0</pose><uri>model://a</uri></include>"), 4,
       "<pose> of world 'w'", "'1m 0 0 0 0 0'"},
      {material("<diffuse>0 0 1 1 blue</diffuse>"), 8, "<diffuse> of visual 'v'",
       "three or four numbers"},
      {link_sdf("<collision name='c'><geometry><empty/></geometry>\n"
                "<max_contacts>1.5</max_contacts></collision>"),
       6, "<max_contacts> of collision 'c'", "one whole number"},
      {material("<pbr><metal><light_map uv_set='1 px'>l.png</light_map></metal></pbr>"), 8,
       "<light_map> of visual 'v'", "uv_set='1 px'"},
      {world_sdf("<model name='m'><link name='l'/><model name='n'><link name='k'>\n"
                 "<inertial><mass>2kg</mass></inertial></link></model></model>"),
       4, "<mass> of link 'k'", "'2kg'"},
      {world_sdf("<gui><camera name='c'>\n<pose>1 m</pose></camera></gui>"), 4,
       "<pose> of camera 'c'", "'1 m'"},
  });
}

TEST(BadWorlds, ResourcesAreRefused) {
  const std::string uri = "<uri> of visual 'v'", map = "<albedo_map> of visual 'v'";
  const std::string repeat = "<tether:texture_repeat> of visual 'v'";
  const std::string long_name(300, 'a');  // no file system allows it
  expect_refused({
      {visual("<mesh>\n<uri>no.obj</uri></mesh>"), 7, uri, "'no.obj'"},
      {visual("<mesh>\n<uri>" + long_name + ".obj</uri></mesh>"), 7, uri, long_name},
      {visual("<mesh><uri>model://nowhere_to_be_found/no.obj</uri></mesh>"), 6, uri,
       "GZ_SIM_RESOURCE_PATH"},
      {visual("<mesh><uri></uri></mesh>"), 6, "", "<uri>"},
      {visual("<mesh><uri>m.ply</uri></mesh>"), 6, uri, ".glb or .gltf"},
      {material("<tether:texture_repeat>2</tether:texture_repeat>"), 8, repeat, "2 finite numbers"},
      {material("\n<tether:texture_repeat>2 -1</tether:texture_repeat>"), 9, repeat},
      {material("<pbr><metal><albedo_map>no.png</albedo_map></metal></pbr>"), 8, map, "'no.png'"},
  });
}

}  // namespace
}  // namespace tether::sim
