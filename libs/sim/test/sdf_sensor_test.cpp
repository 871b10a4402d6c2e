#include "uav_folder.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::sim {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using uav::Vec3;

using SdfSensor = UavModel;

TEST_F(SdfSensor, ReadsACamera) {
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

TEST_F(SdfSensor, IntrinsicsOverrideTheFieldOfView) {
  const auto uav = read(with(kUav, "<distortion>",
                             "<lens><type>gnomonical</type><intrinsics><fx>200</fx><fy>201</fy>"
                             "<cx>160</cx><cy>120</cy></intrinsics></lens><distortion>"));
  const auto& model = std::get<CameraModel>(uav.sensors.at(0).model).intrinsics;
  EXPECT_EQ(model.fx_px, 200.0);
  EXPECT_EQ(model.fy_px, 201.0);
  EXPECT_EQ(model.cx_px, 160.0);
  EXPECT_EQ(model.cy_px, 120.0);
}

TEST_F(SdfSensor, ReadsARangefinderWithItsNoise) {
  const auto range = std::get<RangeModel>(read(kUav).sensors.at(1).model);
  EXPECT_EQ(range.min_m, 0.1);
  EXPECT_EQ(range.max_m, 5.0);
  EXPECT_EQ(range.resolution_m, 0.01);
  EXPECT_EQ(range.noise.mean, 0.5);
  EXPECT_EQ(range.noise.stddev, 0.25);
}

TEST_F(SdfSensor, ReadsImuNoiseOfEachAxis) {
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

TEST_F(SdfSensor, SeveralRaysBecomeTheMiddleOneWithAWarning) {
  const std::string model = with(with(kUav, "<samples>1</samples>", "<samples>3</samples>"),
                                 "<min_angle>0</min_angle><max_angle>0</max_angle>",
                                 "<min_angle>0</min_angle><max_angle>1</max_angle>");
  EXPECT_THAT(warnings(model), ElementsAre(AllOf(HasSubstr("uav.sdf:28: <ray> of sensor 'nose'"),
                                                 HasSubstr("only the middle one"))));
  const Vec3 ray = uav::rotate(read(model).sensors.at(1).X_BS.q, {1, 0, 0});
  EXPECT_NEAR(std::atan2(ray.y, ray.x), 0.5, 1e-9);
}

TEST_F(SdfSensor, OtherSensorsAreLeftOutWithAWarning) {
  const std::string model =
      with(kUav, "</link>", "<sensor name='compass' type='magnetometer'/>\n</link>");
  EXPECT_THAT(warnings(model),
              ElementsAre(HasSubstr("sensor 'compass' is of type 'magnetometer'")));
  EXPECT_EQ(read(model).sensors.size(), 2u);
}

class BadSensors : public BadUavs {};

TEST_P(BadSensors, IsRefusedWithFileAndLine) {
  expect_refusal();
}

const BadUav kBadSensors[] = {
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
    {"no_such_sensor_type", "type='ray'", "type='crystal_ball'", "uav.sdf", "type"},
};

INSTANTIATE_TEST_SUITE_P(Uavs, BadSensors, ::testing::ValuesIn(kBadSensors),
                         [](const auto& given) { return given.param.name; });

}  // namespace
}  // namespace tether::sim
