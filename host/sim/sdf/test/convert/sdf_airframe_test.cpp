#include "uav_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::sim {
namespace {

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
      {"<max_tilt_rad>0.5</max_tilt_rad>\n", "", 3, kMultirotor},
      {"<max_tilt_rad>", "<wings>2</wings>\n<max_tilt_rad>", 15, "<wings> of model 'drone'"},
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
