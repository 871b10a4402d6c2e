#include "sdf_folder.h"

#include <cmath>
#include <ostream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::sim {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using uav::Vec3;

/// A UAV as a test writes it; `with` changes parts of it.
const std::string kUav = R"(<sdf version='1.7' xmlns:tether='https://tether.dev/sdf'>
<model name='drone'>
<tether:multirotor>
<rotor><position_m>0.2 0 0</position_m><direction>cw</direction></rotor>
<rotor><position_m>0 0.2 0</position_m><direction>ccw</direction></rotor>
<rotor><position_m>-0.2 0 0</position_m><direction>cw</direction></rotor>
<rotor><position_m>0 -0.2 0</position_m><direction>ccw</direction></rotor>
<thrust_coefficient_N_s2>1e-5</thrust_coefficient_N_s2>
<moment_coefficient_m>0.02</moment_coefficient_m>
<rotor_drag_N_s2_per_m>0</rotor_drag_N_s2_per_m>
<linear_drag_N_s_per_m>0.25</linear_drag_N_s_per_m>
<max_rotor_speed_rad_s>900</max_rotor_speed_rad_s>
<time_constant_up_s>0.01</time_constant_up_s>
<time_constant_down_s>0.02</time_constant_down_s>
<max_tilt_rad>0.5</max_tilt_rad>
<max_horizontal_speed_m_s>4</max_horizontal_speed_m_s>
<max_vertical_speed_m_s>3</max_vertical_speed_m_s>
<max_yaw_rate_rad_s>2</max_yaw_rate_rad_s>
</tether:multirotor>
<link name='body'>
<inertial><mass>1.5</mass><inertia><ixx>0.01</ixx><iyy>0.02</iyy><izz>0.025</izz></inertia></inertial>
<sensor name='eye' type='camera'><pose>0.1 0 0 0 0.5 0</pose><update_rate>25</update_rate>
<camera><pose>0 0 0.05 0 0 0</pose><horizontal_fov>1.5</horizontal_fov>
<image><width>320</width><height>240</height></image><clip><near>0.1</near><far>20</far></clip>
<distortion><k1>-0.2</k1><p2>0.01</p2></distortion>
</camera></sensor>
<sensor name='nose' type='ray'><update_rate>10</update_rate>
<ray><scan><horizontal><samples>1</samples><resolution>1</resolution><min_angle>0</min_angle><max_angle>0</max_angle></horizontal></scan>
<range><min>0.1</min><max>5</max><resolution>0.01</resolution></range>
<noise><type>gaussian</type><mean>0.5</mean><stddev>0.25</stddev></noise></ray></sensor>
</link>
</model>
</sdf>
)";

/// Loads a UAV into an empty world.
class UavModel : public ::testing::Test {
 protected:
  WorldRequest request(const std::string& model) const {
    return {folder_.write("w.sdf", world_sdf("")),
            {{"uav", folder_.write("uav.sdf", model), {}, 0.0}},
            {}};
  }
  Uav read(const std::string& model) const { return load(request(model)).world.uavs.at(0); }
  std::vector<std::string> warnings(const std::string& model) const {
    return load(request(model)).warnings;
  }

  SdfFolder folder_;
};

TEST_F(UavModel, ReadsTheAirframe) {
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

TEST_F(UavModel, ReadsACamera) {
  const Sensor sensor = read(kUav).sensors.at(0);
  EXPECT_EQ(sensor.name, "eye");
  EXPECT_EQ(sensor.kind(), uav::SensorKind::kCamera);
  EXPECT_EQ(sensor.update_rate_hz, 25.0);
  EXPECT_NEAR(sensor.X_BS.p.x, 0.1 + 0.05 * std::sin(0.5), 1e-9);
  EXPECT_NEAR(sensor.X_BS.p.z, 0.05 * std::cos(0.5), 1e-9);
  const auto& camera = std::get<CameraModel>(sensor.model);
  EXPECT_EQ(camera.intrinsics.width_px, 320);
  EXPECT_NEAR(camera.intrinsics.fx_px, 160.0 / std::tan(0.75), 1e-9);
  EXPECT_EQ(camera.intrinsics.k1, -0.2);
  EXPECT_EQ(camera.intrinsics.p2, 0.01);
  EXPECT_EQ(camera.near_m, 0.1);
  EXPECT_EQ(camera.far_m, 20.0);
  EXPECT_EQ(camera.pixel_noise.stddev, 0.0);
}

TEST_F(UavModel, IntrinsicsOverrideTheFieldOfView) {
  const auto uav = read(with(kUav, "<distortion>",
                             "<lens><type>gnomonical</type><intrinsics><fx>200</fx><fy>201</fy>"
                             "<cx>160</cx><cy>120</cy></intrinsics></lens><distortion>"));
  const auto& model = std::get<CameraModel>(uav.sensors.at(0).model).intrinsics;
  EXPECT_EQ(model.fx_px, 200.0);
  EXPECT_EQ(model.fy_px, 201.0);
  EXPECT_EQ(model.cx_px, 160.0);
  EXPECT_EQ(model.cy_px, 120.0);
}

TEST_F(UavModel, ReadsARangefinderWithItsNoise) {
  const auto range = std::get<RangeModel>(read(kUav).sensors.at(1).model);
  EXPECT_EQ(range.min_m, 0.1);
  EXPECT_EQ(range.max_m, 5.0);
  EXPECT_EQ(range.resolution_m, 0.01);
  EXPECT_EQ(range.noise.mean, 0.5);
  EXPECT_EQ(range.noise.stddev, 0.25);
}

TEST_F(UavModel, ReadsImuNoiseOfEachAxis) {
  const auto uav = read(with(kUav, "</link>", R"(<sensor name='imu' type='imu'><imu>
      <angular_velocity><z><noise type='gaussian'><mean>0</mean><stddev>0.5</stddev>
        <dynamic_bias_stddev>0.25</dynamic_bias_stddev>
        <dynamic_bias_correlation_time>100</dynamic_bias_correlation_time></noise></z></angular_velocity>
      <linear_acceleration><x><noise type='gaussian'><mean>0</mean><stddev>0.125</stddev>
        <bias_mean>1</bias_mean><bias_stddev>2</bias_stddev></noise></x></linear_acceleration>
      </imu></sensor></link>)"));
  const auto& imu = std::get<ImuModel>(uav.sensors.at(2).model);
  EXPECT_EQ(imu.angular_velocity[0].stddev, 0.0);
  EXPECT_EQ(imu.angular_velocity[2].stddev, 0.5);
  EXPECT_EQ(imu.angular_velocity[2].dynamic_bias_correlation_time_s, 100.0);
  EXPECT_EQ(imu.linear_acceleration[0].stddev, 0.125);
  EXPECT_EQ(imu.linear_acceleration[0].bias_stddev, 2.0);
}

TEST_F(UavModel, SeveralRaysBecomeTheMiddleOneWithAWarning) {
  const std::string model = with(with(kUav, "<samples>1</samples>", "<samples>3</samples>"),
                                 "<min_angle>0</min_angle><max_angle>0</max_angle>",
                                 "<min_angle>0</min_angle><max_angle>1</max_angle>");
  EXPECT_THAT(warnings(model), ElementsAre(AllOf(HasSubstr("uav.sdf:28: <ray> of sensor 'nose'"),
                                                 HasSubstr("only the middle one"))));
  const Vec3 ray = uav::rotate(read(model).sensors.at(1).X_BS.q, {1, 0, 0});
  EXPECT_NEAR(std::atan2(ray.y, ray.x), 0.5, 1e-9);
}

TEST_F(UavModel, OtherSensorsAreLeftOutWithAWarning) {
  const std::string model =
      with(kUav, "</link>", "<sensor name='compass' type='magnetometer'/>\n</link>");
  EXPECT_THAT(warnings(model),
              ElementsAre(HasSubstr("sensor 'compass' is of type 'magnetometer'")));
  EXPECT_EQ(read(model).sensors.size(), 2u);
}

TEST_F(UavModel, FixedLinksAreMergedAndMovingOnesLeftOut) {
  const std::string model = with(kUav, "</link>", R"(</link>
      <link name='arm'><pose>0 0 1 0 0 0</pose>
        <visual name='v'><geometry><sphere><radius>0.1</radius></sphere></geometry></visual>
        <sensor name='imu' type='imu'><pose>0 1 0 0 0 0</pose></sensor></link>
      <link name='wheel'/>
      <joint name='weld' type='fixed'><parent>body</parent><child>arm</child></joint>
      <joint name='axle' type='revolute'><parent>body</parent><child>wheel</child>
        <axis><xyz>0 0 1</xyz></axis></joint>)");
  EXPECT_THAT(warnings(model),
              ElementsAre(HasSubstr("link 'arm' is merged into link 'body'"),
                          HasSubstr("link 'wheel' is not fixed to link 'body'; left out"),
                          HasSubstr("joint 'axle' can move")));
  const Uav uav = read(model);
  ASSERT_EQ(uav.body.visuals.size(), 1u);
  EXPECT_EQ(uav.body.visuals[0].X_LV.p, (Vec3{0, 0, 1}));
  EXPECT_EQ(uav.sensors.at(2).X_BS.p, (Vec3{0, 1, 1}));
}

struct BadUav {
  const char* name;
  const char* from;
  const char* to;
  const char* where;
  const char* message;
};

std::ostream& operator<<(std::ostream& out, const BadUav& bad) {
  return out << bad.name;
}

const BadUav kBadUavs[] = {
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
    {"rotor_without_direction", "<direction>cw</direction>", "",
     "uav.sdf:4: ", "<rotor> of model 'drone' has no <direction>"},
    {"three_rotors", "<rotor><position_m>0 -0.2 0</position_m><direction>ccw</direction></rotor>",
     "", "uav.sdf:3: ", "has 3 rotors; it must have 4 to 8"},
    {"too_heavy", "<mass>1.5", "<mass>15", "uav.sdf:3: ", "cannot lift its own weight"},
    {"centre_of_mass_aside", "<inertial>", "<inertial><pose>0.1 0 0 0 0 0</pose>",
     "uav.sdf:2: ", "centre of mass off the origin of link 'body'"},
    {"wide_field_of_view", "<horizontal_fov>1.5", "<horizontal_fov>3.2",
     "uav.sdf:23: ", "<horizontal_fov> of sensor 'eye' is 3.2; it must be between 0 and pi"},
    {"no_field_of_view", "<horizontal_fov>1.5", "<horizontal_fov>-1", "uav.sdf:23: ", "-1"},
    {"image_of_no_width", "<width>320", "<width>0", "uav.sdf:24: ", "between 1 and 4096 pixels"},
    {"negative_height", "<height>240", "<height>-240", "uav.sdf:24: ", "between 1 and 4096"},
    {"huge_image", "<width>320", "<width>4097", "uav.sdf:24: ", "between 1 and 4096 pixels"},
    {"near_behind_far", "<near>0.1", "<near>30", "uav.sdf:24: ", "near plane behind its far"},
    {"range_upside_down", "<min>0.1", "<min>6", "uav.sdf:29: ", "not below its maximum"},
    {"negative_noise", "<stddev>0.25", "<stddev>-0.25", "uav.sdf:30: ", "must not be negative"},
    {"negative_rate", "<update_rate>25", "<update_rate>-25",
     "uav.sdf:22: ", "must not be negative"},
    {"two_sensors_of_one_name", "name='nose'", "name='eye'", "uav.sdf", "eye"},
    {"no_such_sensor_type", "type='ray'", "type='crystal_ball'", "uav.sdf", "type"},
};

class BadUavs : public UavModel, public ::testing::WithParamInterface<BadUav> {};

TEST_P(BadUavs, IsRefusedWithFileAndLine) {
  const std::string message = refusal(request(with(kUav, GetParam().from, GetParam().to)));
  EXPECT_THAT(message, HasSubstr(GetParam().where));
  EXPECT_THAT(message, HasSubstr(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(Uavs, BadUavs, ::testing::ValuesIn(kBadUavs),
                         [](const auto& given) { return given.param.name; });

TEST_F(UavModel, WithoutMultirotorIsNoUav) {
  std::string model = kUav;
  const std::size_t begin = model.find("<tether:multirotor>");
  const std::string end = "</tether:multirotor>";
  model.erase(begin, model.find(end) + end.size() - begin);
  EXPECT_THAT(refusal(request(model)),
              HasSubstr("uav.sdf:2: model 'drone' has no <tether:multirotor>"));
}

TEST_F(UavModel, AWorldIsNoUav) {
  EXPECT_THAT(refusal(request(world_sdf(""))), HasSubstr("uav.sdf: has no <model>"));
}

}  // namespace
}  // namespace tether::sim
