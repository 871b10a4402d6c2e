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
  const ScratchFolder folder;
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
    {"no_element", "<?xml version='1.0'?>\n<!-- nothing -->", "w.sdf: ", "has no element"},
    {"other_root", "<html>\n</html>", "w.sdf:1: ", "an SDF file begins with <sdf>"},
    {"a_version_that_is_no_number", "<sdf version='1.x'>\n<world name='w'/></sdf>",
     "w.sdf: ", "libsdformat cannot read it (stoi); look at <sdf version='...'>"},
    {"no_world", "<sdf version='1.7'>\n</sdf>", "w.sdf: ", "0 <world> elements"},
    {"two_worlds", "<sdf version='1.7'>\n<world name='a'/>\n<world name='b'/>\n</sdf>",
     "w.sdf: ", "2 <world> elements"},
    {"unknown_include", world_sdf("<include>\n<uri>model://nothing</uri></include>"),
     "w.sdf:4: ", "nothing"},
    {"a_path_that_no_file_can_have",
     visual("<mesh>\n<uri>" + std::string(300, 'a') + ".obj</uri></mesh>"),
     "w.sdf:", "does not exist"},
    // Longer than what std::regex has stack for.
    {"a_message_as_long_as_the_file",
     world_sdf("<model name='" + std::string(1'000'000, 'a') +
               "'><pose relative_to='zz'/>"
               "<link name='l'/></model>"),
     "w.sdf:", "aaa"},
    {"a_value_below_a_name_as_long",
     world_sdf("<model name='m'><link name='" + std::string(1'000'000, 'a') +
               "'>\n<gravity>perhaps</gravity></link></model>"),
     "w.sdf:4: ", "Error reading element <gravity>: Invalid boolean value"},
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

const BadWorld kBadNumbers[] = {
    {"mass_with_unit", link_sdf("<inertial>\n<mass>1 kg</mass></inertial>"),
     "w.sdf:6: ", "<mass> of link 'l' is '1 kg'; it must be one number in kilograms, without unit"},
    {"size_with_unit", visual("<box>\n<size>1 1 1 m</size></box>"), "w.sdf:7: ",
     "<size> of visual 'v' is '1 1 1 m'; it must be three numbers in metres, without unit"},
    {"angle_with_unit",
     world_sdf("<light name='s' type='spot'><spot>\n<outer_angle>11.5deg</outer_angle></spot>"
               "</light>"),
     "w.sdf:4: ", "'11.5deg'; it must be one number in radians, without unit"},
    {"size_of_two_numbers", visual("<box><size>1 1</size></box>"), "w.sdf:6: ", "three numbers"},
    {"size_of_four_numbers", visual("<box><size>1 1 1 1</size></box>"),
     "w.sdf:6: ", "three numbers"},
    {"decimal_comma", visual("<sphere><radius>2,5</radius></sphere>"), "w.sdf:6: ", "'2,5'"},
    {"no_number", visual("<sphere><radius/></sphere>"),
     "w.sdf:6: ", "is ''; it must be one number"},
    {"unit_behind_a_comment", visual("<sphere><radius>2<!-- --> m</radius></sphere>"),
     "w.sdf:6: ", "'2 m'"},
    {"pose_with_unit", link_sdf("<pose>0 0 1 m 0 0 0</pose>"),
     "w.sdf:5: ", "six numbers, metres and radians, without unit"},
    {"pose_in_degrees", link_sdf("<pose degrees='true'>0 0 1 0 0 90deg</pose>"),
     "w.sdf:5: ", "six numbers, metres and degrees, without unit"},
    {"quaternion_pose", link_sdf("<pose rotation_format='quat_xyzw'>0 0 1 0 0 0</pose>"),
     "w.sdf:5: ", "seven numbers"},
    {"pose_of_an_include",
     world_sdf("<include>\n<pose>1m 0 0 0 0 0</pose><uri>model://a</uri></include>"),
     "w.sdf:4: ", "'1m 0 0 0 0 0'"},
    {"colour_with_text",
     visual("<empty/>", "<material>\n<diffuse>0 0 1 1 blue</diffuse></material>"),
     "w.sdf:8: ", "three or four numbers"},
    {"whole_number",
     world_sdf("<model name='m'><link name='l'><collision name='c'><geometry><empty/></geometry>\n"
               "<max_contacts>1.5</max_contacts></collision></link></model>"),
     "w.sdf:4: ", "'1.5'; it must be one whole number"},
    {"attribute",
     visual("<empty/>",
            "<material><pbr><metal>\n<light_map uv_set='1 px'>l.png</light_map></metal>"
            "</pbr></material>"),
     "w.sdf:8: ", "<light_map> of visual 'v' has uv_set='1 px'; it must be one whole number"},
    {"nested_model",
     world_sdf("<model name='m'><link name='l'/><model name='n'><link name='k'>\n"
               "<inertial><mass>2kg</mass></inertial></link></model></model>"),
     "w.sdf:4: ", "<mass> of link 'k' is '2kg'"},
    {"element_without_effect", world_sdf("<gui><camera name='c'>\n<pose>1 m</pose></camera></gui>"),
     "w.sdf:4: ", "'1 m'"},
    {"absurd_size", visual("<box><size>1e300 1 1</size></box>"),
     "w.sdf:6: ", "it must be greater than 0 and at most 100000 m"},
    {"size_beyond_a_double", visual("<box><size>1e400 1 1</size></box>"), "w.sdf:6: ", "1e400"},
    {"absurd_mass", link_sdf("<inertial><mass>1e7</mass></inertial>"),
     "w.sdf:5: ", "at most 1000000 kg"},
    {"absurd_position", link_sdf("<pose>0 -1e6 0 0 0 0</pose>"),
     "w.sdf:5: ", "within 100000 m of its frame's origin"},
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
INSTANTIATE_TEST_SUITE_P(Numbers, BadWorlds, ::testing::ValuesIn(kBadNumbers), name_of);
INSTANTIATE_TEST_SUITE_P(Resources, BadWorlds, ::testing::ValuesIn(kBadResources), name_of);

}  // namespace
}  // namespace tether::sim
