#include "uav_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::sim {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using uav::Vec3;

using SdfAirframe = UavModel;

TEST_F(SdfAirframe, ReadsTheAirframe) {
  const uav::MultirotorParameters airframe = read(kUav).airframe;
  EXPECT_EQ(airframe.mass_kg, 1.5);
  EXPECT_EQ(airframe.inertia_kg_m2, (Vec3{0.01, 0.02, 0.025}));
  ASSERT_EQ(airframe.rotors.size(), 4u);
  EXPECT_EQ(airframe.rotors[0].direction, -1);
  EXPECT_EQ(airframe.rotors[1].direction, 1);
  EXPECT_EQ(airframe.rotors[1].p_BR, (Vec3{0, 0.2, 0}));
  EXPECT_EQ(airframe.thrust_coefficient, 1e-5);
  EXPECT_EQ(airframe.linear_drag_N_s_m, 0.25);
  EXPECT_EQ(airframe.time_constant_down_s, 0.02);
  EXPECT_EQ(airframe.max_yaw_rate_rad_s, 2.0);
  EXPECT_THAT(warnings(kUav), IsEmpty());
}

TEST_F(SdfAirframe, WithoutMultirotorIsNoUav) {
  std::string model = kUav;
  const std::size_t begin = model.find("<tether:multirotor>");
  const std::string end = "</tether:multirotor>";
  model.erase(begin, model.find(end) + end.size() - begin);
  EXPECT_THAT(refusal(request(model)),
              HasSubstr("uav.sdf:2: model 'drone' has no <tether:multirotor>"));
}

class BadAirframes : public BadUavs {};

TEST_P(BadAirframes, IsRefusedWithFileAndLine) {
  expect_refusal();
}

const BadUav kBadAirframes[] = {
    {"missing_parameter", "<max_tilt_rad>0.5</max_tilt_rad>\n", "",
     "uav.sdf:3: ", "has no <max_tilt_rad>, which is required"},
    {"unknown_parameter", "<max_tilt_rad>", "<wings>2</wings>\n<max_tilt_rad>", "uav.sdf:15: ",
     "<wings> of model 'drone' is no parameter of a multirotor; allowed are rotor, thrust"},
    {"negative_parameter", "<max_tilt_rad>0.5", "<max_tilt_rad>-0.5",
     "uav.sdf:15: ", "is -0.5; it must be greater than 0"},
    {"zero_parameter", "<max_tilt_rad>0.5", "<max_tilt_rad>0", "uav.sdf:15: ", "greater than 0"},
    {"negative_drag", "_per_m>0.25", "_per_m>-1", "uav.sdf:11: ", "must not be negative"},
    {"parameter_with_unit", "<max_tilt_rad>0.5", "<max_tilt_rad>20 deg",
     "uav.sdf:15: ", "is '20 deg'; it must be 1 finite number"},
    {"nan_parameter", "<max_tilt_rad>0.5", "<max_tilt_rad>nan", "uav.sdf:15: ", "finite number"},
    {"rotor_direction", "<direction>ccw", "<direction>left",
     "uav.sdf:5: ", "is 'left'; it must be cw or ccw"},
    {"rotor_position", "<position_m>0 -0.2 0", "<position_m>0 -0.2",
     "uav.sdf:7: ", "3 finite numbers"},
    {"absurd_rotor_position", "<position_m>0 -0.2 0", "<position_m>0 -1e6 0",
     "uav.sdf:7: ", "within 100000 m"},
    {"rotor_without_direction", "<direction>cw</direction>", "",
     "uav.sdf:4: ", "<rotor> of model 'drone' has no <direction>"},
    {"three_rotors", "<rotor><position_m>0 -0.2 0</position_m><direction>ccw</direction></rotor>",
     "", "uav.sdf:3: ", "has 3 rotors; it must have 4 to 8"},
    {"too_heavy", "<mass>1.5", "<mass>15", "uav.sdf:3: ", "cannot lift its own weight"},
    {"centre_of_mass_aside", "<inertial>", "<inertial><pose>0.1 0 0 0 0 0</pose>",
     "uav.sdf:2: ", "centre of mass off the origin of link 'body'"},
};

INSTANTIATE_TEST_SUITE_P(Uavs, BadAirframes, ::testing::ValuesIn(kBadAirframes),
                         [](const auto& given) { return given.param.name; });

}  // namespace
}  // namespace tether::sim
