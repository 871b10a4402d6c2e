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

/// kUav with nothing in <tether:multirotor> but this.
std::string with_multirotor(const std::string& elements) {
  std::string model = kUav;
  const std::size_t begin = model.find("<rotor>");
  return model.replace(begin, model.find("</tether:multirotor>") - begin, elements);
}

TEST_F(SdfAirframe, HasTheHummingbirdsValuesForWhatIsMissing) {
  std::string rotors;
  for (const char* rotor :
       {"1 0 0</position_m><direction>cw", "0 1 0</position_m><direction>ccw",
        "-1 0 0</position_m><direction>cw", "0 -1 0</position_m><direction>ccw"})
    rotors += "<rotor><position_m>" + std::string(rotor) + "</direction></rotor>\n";
  const uav::MultirotorParameters airframe =
      read(with_multirotor(rotors + "<thrust_coefficient_N_s2>1e-5</thrust_coefficient_N_s2>"
                                    "<max_rotor_speed_rad_s>900</max_rotor_speed_rad_s>"))
          .airframe;
  const uav::MultirotorParameters hummingbird = uav::hummingbird();
  EXPECT_EQ(airframe.moment_coefficient_m, hummingbird.moment_coefficient_m);
  EXPECT_EQ(airframe.drag_coefficient, hummingbird.drag_coefficient);
  EXPECT_EQ(airframe.linear_drag_N_s_m, hummingbird.linear_drag_N_s_m);
  EXPECT_EQ(airframe.time_constant_up_s, hummingbird.time_constant_up_s);
  EXPECT_EQ(airframe.time_constant_down_s, hummingbird.time_constant_down_s);
  EXPECT_EQ(airframe.max_tilt_rad, hummingbird.max_tilt_rad);
  EXPECT_EQ(airframe.max_horizontal_speed_m_s, hummingbird.max_horizontal_speed_m_s);
  EXPECT_EQ(airframe.max_vertical_speed_m_s, hummingbird.max_vertical_speed_m_s);
  EXPECT_EQ(airframe.max_yaw_rate_rad_s, hummingbird.max_yaw_rate_rad_s);
}

TEST_F(SdfAirframe, NamesAllThatIsMissingAtOnce) {
  const auto message = [&](const std::string& elements) {
    return std::string(refusal(request(with_multirotor(elements))).what());
  };
  for (const char* name : {"<rotor>", "<thrust_coefficient_N_s2>", "<max_rotor_speed_rad_s>"})
    EXPECT_THAT(message("\n"), HasSubstr(name));
  EXPECT_THAT(message("<rotor/><thrust_coefficient_N_s2>1</thrust_coefficient_N_s2>"
                      "<max_rotor_speed_rad_s>1</max_rotor_speed_rad_s>"),
              HasSubstr("lacks <position_m>, <direction>;"));
}

TEST_F(SdfAirframe, RequiresAMultirotor) {
  std::string model = kUav;
  const std::size_t begin = model.find("<tether:multirotor>");
  const std::string end = "</tether:multirotor>";
  model.erase(begin, model.find(end) + end.size() - begin);
  expect_error(refusal(request(model)), folder_.path("uav.sdf"), 2, "model 'drone'");
}

using BadAirframes = BadUavs;

TEST_F(BadAirframes, AreRefused) {
  const char* const kMultirotor = "<tether:multirotor> of model 'drone'";
  const char* const kTilt = "<max_tilt_rad> of model 'drone'";
  const char* const kPosition = "<position_m> of model 'drone'";
  expect_refused({
      {"<max_rotor_speed_rad_s>900</max_rotor_speed_rad_s>\n", "", 3, kMultirotor},
      {"<max_tilt_rad>", "<wings>2</wings>\n<max_tilt_rad>", 15, "<wings> of model 'drone'"},
      {"<max_rotor_speed_rad_s>900</max_rotor_speed_rad_s>",
       "<max_rotor_speed_rpm>9</max_rotor_speed_rpm>", 12,
       "<max_rotor_speed_rpm> of model 'drone'"},
      {"<max_tilt_rad>0.5", "<max_tilt_rad>-0.5", 15, kTilt},
      {"<max_tilt_rad>0.5", "<max_tilt_rad>0", 15, kTilt},
      {"<max_tilt_rad>0.5", "<max_tilt_rad>20 deg", 15, kTilt},
      {"<max_tilt_rad>0.5", "<max_tilt_rad>nan", 15, kTilt},
      {"_per_m>0.25", "_per_m>-1", 11, "<linear_drag_N_s_per_m> of model 'drone'"},
      {"<direction>ccw", "<direction>left", 5, "<direction> of model 'drone'"},
      {"<position_m>0 -0.2 0", "<position_m>0 -0.2", 7, kPosition},
      {"<position_m>0 -0.2 0", "<position_m>0 -1e6 0", 7, kPosition},
      {"<direction>cw</direction>", "", 4, "<rotor> of model 'drone'"},
      {"<rotor><position_m>0 -0.2 0</position_m><direction>ccw</direction></rotor>", "", 3,
       kMultirotor},
      {"<mass>1.5", "<mass>15", 3, kMultirotor},
      {"<inertial>", "<inertial><pose>0.1 0 0 0 0 0</pose>", 2, "model 'drone'"},
  });
}

}  // namespace
}  // namespace tether::sim
