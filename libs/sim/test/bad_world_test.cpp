#include "sdf_folder.h"

#include <ostream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// Each way in which a world cannot be used: where the error points, and what it says.
namespace tether::sim {
namespace {

using ::testing::HasSubstr;

struct BadWorld {
  const char* name;
  std::string text;
  const char* where;  ///< "w.sdf:LINE: "
  const char* message;
};

std::ostream& operator<<(std::ostream& out, const BadWorld& bad) {
  return out << bad.name;
}

std::string visual(const std::string& geometry, const std::string& material = "") {
  return link_sdf("<visual name='v'>\n<geometry>" + geometry + "</geometry>\n" + material +
                  "</visual>");
}

class BadWorlds : public ::testing::TestWithParam<BadWorld> {};

TEST_P(BadWorlds, IsRefusedWithFileAndLine) {
  const SdfFolder folder;
  const auto file = folder.write("w.sdf", GetParam().text);
  folder.write("t.jpg", "jpg");
  folder.write("m.ply", "ply");
  const std::string message = refusal({file, {}, {}});
  EXPECT_THAT(message, HasSubstr(file.parent_path().string() + "/" + GetParam().where));
  EXPECT_THAT(message, HasSubstr(GetParam().message));
  EXPECT_EQ(message.find('\n'), std::string::npos);
}

const BadWorld kBadFiles[] = {
    {"not_xml", "<sdf version='1.7'>\n<world></sdf>", "w.sdf:2: ", "not well-formed XML"},
    {"empty", "", "w.sdf: ", "not well-formed XML"},
    {"other_root", "<html>\n</html>", "w.sdf:1: ", "an SDF file begins with <sdf>"},
    {"no_world", "<sdf version='1.7'>\n</sdf>", "w.sdf: ", "0 <world> elements"},
    {"two_worlds", "<sdf version='1.7'>\n<world name='a'/>\n<world name='b'/>\n</sdf>",
     "w.sdf: ", "2 <world> elements"},
    {"unknown_include", world_sdf("<include>\n<uri>model://nothing</uri></include>"),
     "w.sdf:4: ", "nothing"},
    {"two_models_of_one_name",
     world_sdf("<model name='a'><link name='l'/></model>\n"
               "<model name='a'><link name='l'/></model>"),
     "w.sdf:3: ", "name[a]"},
    {"unknown_frame",
     world_sdf(
         "\n<model name='m'><pose relative_to='zz'>0 0 0 0 0 0</pose><link name='l'/></model>"),
     "w.sdf:4: ", "zz"},
};

const BadWorld kBadValues[] = {
    {"text_for_number", link_sdf("<inertial>\n<mass>heavy</mass></inertial>"),
     "w.sdf:6: ", "heavy"},
    {"negative_mass", link_sdf("<inertial>\n<mass>-2</mass></inertial>"),
     "w.sdf:6: ", "<mass> of link 'l' is -2; it must be greater than 0"},
    {"nan_mass", link_sdf("<inertial>\n<mass>nan</mass></inertial>"),
     "w.sdf:6: ", "must be finite"},
    {"impossible_inertia",
     link_sdf("<inertial><inertia><ixx>1</ixx><iyy>1</iyy><izz>9</izz></inertia></inertial>"),
     "w.sdf:4: ", "none larger than the sum of the other two"},
    {"zero_box", visual("<box><size>1 0 1</size></box>"),
     "w.sdf:6: ", "<size> of visual 'v' is 1 0 1; it must be greater than 0"},
    {"negative_radius", visual("<sphere><radius>-1</radius></sphere>"),
     "w.sdf:6: ", "greater than 0"},
    {"infinite_length", visual("<cylinder><radius>1</radius><length>inf</length></cylinder>"),
     "w.sdf:6: ", "must be finite"},
    {"nan_pose",
     link_sdf("<visual name='v'><pose>0 0 nan 0 0 0</pose>"
              "<geometry><empty/></geometry></visual>"),
     "w.sdf:5: ", "<pose>: Pose values must be finite"},
    {"colour_out_of_range",
     visual("<empty/>", "<material>\n<diffuse>0 0 200 1</diffuse></material>"),
     "w.sdf:8: ", "between 0 and 1"},
    {"negative_friction",
     link_sdf("<collision name='c'><geometry><empty/></geometry><surface>"
              "<friction><ode><mu>-1</mu></ode></friction></surface></collision>"),
     "w.sdf:5: ", "must not be negative"},
    {"gravity_sideways", world_sdf("<gravity>1 0 -9.81</gravity>"), "w.sdf:3: ", "along -z"},
    {"no_gravity", world_sdf("<gravity>0 0 0</gravity>"), "w.sdf:3: ", "along -z"},
    {"zero_step",
     world_sdf("<physics name='p' type='ode'>\n<max_step_size>0</max_step_size></physics>"),
     "w.sdf:4: ", "greater than 0"},
    {"long_step",
     world_sdf("<physics name='p' type='ode'>\n<max_step_size>1</max_step_size></physics>"),
     "w.sdf:4: ", "between 0.00001 and 0.02 seconds"},
    {"light_without_direction",
     world_sdf("<light name='s' type='directional'><direction>0 0 0</direction></light>"),
     "w.sdf:3: ", "length 0"},
};

const BadWorld kBadResources[] = {
    {"missing_mesh", visual("<mesh>\n<uri>no.obj</uri></mesh>"),
     "w.sdf:7: ", "<uri> of visual 'v' names the file 'no.obj', which does not exist"},
    {"missing_model_mesh", visual("<mesh><uri>model://a/no.obj</uri></mesh>"),
     "w.sdf:6: ", "in the model path"},
    {"mesh_without_file", visual("<mesh><uri></uri></mesh>"), "w.sdf:6: ", "Key[uri]"},
    {"unknown_mesh_format", visual("<mesh><uri>m.ply</uri></mesh>"),
     "w.sdf:6: ", ".obj, .stl or .dae"},
    {"repeat_of_one_number",
     visual("<box><size>1 1 1</size></box>",
            "<material>\n<tether:texture_repeat>2</tether:texture_repeat></material>"),
     "w.sdf:8: ", "it must be 2 finite numbers"},
    {"negative_repeat",
     visual("<box><size>1 1 1</size></box>",
            "<material>\n\n<tether:texture_repeat>2 -1</tether:texture_repeat></material>"),
     "w.sdf:9: ", "greater than 0"},
    {"missing_texture",
     visual("<box><size>1 1 1</size></box>",
            "<material><pbr><metal>\n<albedo_map>no.png</albedo_map></metal></pbr></material>"),
     "w.sdf:8: ", "<albedo_map> of visual 'v' names the file 'no.png'"},
    {"texture_that_is_no_png",
     visual("<box><size>1 1 1</size></box>",
            "<material><pbr><metal>\n<albedo_map>t.jpg</albedo_map></metal></pbr></material>"),
     "w.sdf:8: ", "must name a .png file"},
};

std::string name_of(const ::testing::TestParamInfo<BadWorld>& info) {
  return info.param.name;
}

INSTANTIATE_TEST_SUITE_P(Files, BadWorlds, ::testing::ValuesIn(kBadFiles), name_of);
INSTANTIATE_TEST_SUITE_P(Values, BadWorlds, ::testing::ValuesIn(kBadValues), name_of);
INSTANTIATE_TEST_SUITE_P(Resources, BadWorlds, ::testing::ValuesIn(kBadResources), name_of);

}  // namespace
}  // namespace tether::sim
