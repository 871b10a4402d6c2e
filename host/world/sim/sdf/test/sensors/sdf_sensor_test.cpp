#include "uav_folder.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::sim {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
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

TEST_F(SdfSensor, ReadsIntrinsicsDistortionAndPixelNoise) {
  const auto uav = read(with(kUav, "<distortion><k1>-0.2</k1><p2>0.01</p2>",
                             "<lens><type>gnomonical</type><intrinsics><fx>200</fx><fy>201</fy>"
                             "<cx>160</cx><cy>120</cy></intrinsics></lens>"
                             "<noise><type>gaussian</type><mean>0.01</mean><stddev>0.02</stddev>"
                             "</noise><distortion><k1>0.1</k1><k2>0.2</k2><k3>0.3</k3>"
                             "<p1>0.4</p1><p2>0.5</p2>"));
  const auto& camera = std::get<CameraModel>(uav.sensors.at(0).model);
  const uav::CameraModel& m = camera.intrinsics;
  EXPECT_THAT((std::vector{m.fx_px, m.fy_px, m.cx_px, m.cy_px, m.k1, m.k2, m.k3, m.p1, m.p2}),
              ElementsAre(200.0, 201.0, 160.0, 120.0, 0.1, 0.2, 0.3, 0.4, 0.5));
  EXPECT_EQ(camera.pixel_noise.mean, 0.01);
  EXPECT_EQ(camera.pixel_noise.stddev, 0.02);
}

TEST_F(SdfSensor, ReadsOtherCameras) {
  struct OtherCamera {
    const char* type;
    const char* inside;
    uav::CameraKind kind;
    double near_m, far_m, depth_min_m, depth_max_m;
  };
  const char* const clip =
      "<depth_camera><output>depths</output><clip><near>0.3</near><far>8</far></clip></"
      "depth_camera>";
  const char* const far_clip = "<depth_camera><clip><far>50</far></clip></depth_camera>";
  for (const OtherCamera& c :
       {OtherCamera{"depth_camera", "", uav::CameraKind::kDepth, 0.1, 20.0, 0.1, 20.0},
        OtherCamera{"depth", clip, uav::CameraKind::kDepth, 0.1, 8.0, 0.3, 8.0},
        OtherCamera{"rgbd_camera", clip, uav::CameraKind::kRgbd, 0.1, 20.0, 0.3, 8.0},
        OtherCamera{"rgbd", "", uav::CameraKind::kRgbd, 0.1, 20.0, 0.1, 20.0},
        OtherCamera{"rgbd", far_clip, uav::CameraKind::kRgbd, 0.1, 20.0, 0.1, 20.0},
        OtherCamera{"depth", far_clip, uav::CameraKind::kDepth, 0.1, 50.0, 0.1, 50.0},
        OtherCamera{"segmentation", "", uav::CameraKind::kSegmentation, 0.1, 20.0, 0.0, 0.0},
        OtherCamera{"segmentation_camera", "", uav::CameraKind::kSegmentation, 0.1, 20.0, 0.0,
                    0.0}}) {
    const std::string model =
        with(with(kUav, "type='camera'", "type='" + std::string(c.type) + "'"), "</camera>",
             std::string(c.inside) + "</camera>");
    const Sensor sensor = read(model).sensors.at(0);
    const auto& camera = std::get<CameraModel>(sensor.model);
    EXPECT_EQ(camera.kind, c.kind) << c.type;
    EXPECT_EQ((std::vector{camera.near_m, camera.far_m, camera.depth_min_m, camera.depth_max_m}),
              (std::vector{c.near_m, c.far_m, c.depth_min_m, c.depth_max_m}))
        << c.type;
    EXPECT_GT(sensor.declared_at.line, 0);
    EXPECT_THAT(sensor.declared_at.file, HasSubstr(".sdf"));
  }
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
  std::string axes[2];
  const char* names[] = {"x", "y", "z"};
  for (int i = 0; i < 6; ++i) {
    const std::string n = names[i % 3], digit = std::to_string(i + 1);
    axes[i / 3] +=
        "<" + n + "><noise type='gaussian'><mean>0</mean><stddev>0." + digit +
        "</stddev><bias_mean>1</bias_mean><bias_stddev>2</bias_stddev>"
        "<dynamic_bias_stddev>0.25</dynamic_bias_stddev><dynamic_bias_correlation_time>" +
        digit + "</dynamic_bias_correlation_time></noise></" + n + ">";
  }
  const auto uav = read(with(kUav, "</link>",
                             "<sensor name='imu' type='imu'><imu><angular_velocity>" + axes[0] +
                                 "</angular_velocity><linear_acceleration>" + axes[1] +
                                 "</linear_acceleration></imu></sensor></link>"));
  const auto& imu = std::get<ImuModel>(uav.sensors.at(2).model);
  for (std::size_t i = 0; i < 6; ++i) {
    const Noise& noise = i < 3 ? imu.angular_velocity[i] : imu.linear_acceleration[i - 3];
    EXPECT_NEAR(noise.stddev, 0.1 * static_cast<double>(i + 1), 1e-12);
    EXPECT_EQ(noise.bias_mean, 1.0);
    EXPECT_EQ(noise.bias_stddev, 2.0);
    EXPECT_EQ(noise.dynamic_bias_stddev, 0.25);
    EXPECT_EQ(noise.dynamic_bias_correlation_time_s, static_cast<double>(i + 1));
  }
}

// Azimuth and elevation of a ray.
std::pair<double, double> angles_of(const Vec3& ray) {
  return {std::atan2(ray.y, ray.x), std::atan2(ray.z, std::hypot(ray.x, ray.y))};
}

std::string with_scan(const std::string& horizontal, const std::string& vertical) {
  return with(kUav,
              "<horizontal><samples>1</samples><resolution>1</resolution><min_angle>0</min_angle>"
              "<max_angle>0</max_angle></horizontal>",
              "<horizontal>" + horizontal + "</horizontal><vertical>" + vertical + "</vertical>");
}
std::string axis(int samples, const std::string& min_rad, const std::string& max_rad) {
  return "<samples>" + std::to_string(samples) + "</samples><resolution>1</resolution><min_angle>" +
         min_rad + "</min_angle><max_angle>" + max_rad + "</max_angle>";
}

TEST_F(SdfSensor, ASingleRayTurnsTheSensor) {
  const std::string model = with_scan(axis(1, "0", "1"), axis(1, "-0.2", "-0.2"));
  EXPECT_THAT(warnings(model), IsEmpty());
  const Sensor sensor = read(model).sensors.at(1);
  EXPECT_EQ(std::get<RangeModel>(sensor.model).rays_S, (std::vector<Vec3>{{1.0, 0.0, 0.0}}));
  const auto [azimuth, elevation] = angles_of(uav::rotate(sensor.X_BS.q, {1, 0, 0}));
  EXPECT_NEAR(azimuth, 0.5, 1e-9);
  EXPECT_NEAR(elevation, -0.2, 1e-9);
}

TEST_F(SdfSensor, AScanEndsAfterItsBeginning) {
  EXPECT_THAT(refusal(request(with_scan(axis(9, "2.5", "-2.0"), axis(1, "0", "0")))).what(),
              HasSubstr("min_angle that is above"));
}

TEST_F(SdfSensor, SeveralRaysAreAScan) {
  const std::string model = with_scan(axis(1080, "-2.0", "2.5"), axis(16, "-0.1", "0.3"));
  EXPECT_THAT(warnings(model), IsEmpty());
  const Sensor sensor = read(model).sensors.at(1);
  EXPECT_EQ(sensor.kind(), uav::SensorKind::kScan);
  EXPECT_EQ(sensor.X_BS.q, uav::Quat{});
  const auto& scan = std::get<ScanModel>(sensor.model);
  EXPECT_EQ(scan.rays.columns, 1080);
  EXPECT_EQ(scan.rays.rows, 16);
  EXPECT_EQ((std::vector{scan.rays.min_azimuth_rad, scan.rays.max_azimuth_rad,
                         scan.rays.min_elevation_rad, scan.rays.max_elevation_rad}),
            (std::vector{-2.0, 2.5, -0.1, 0.3}));
  EXPECT_EQ((std::vector{scan.rays.min_m, scan.rays.max_m, scan.resolution_m, scan.noise.stddev}),
            (std::vector{0.1, 5.0, 0.01, 0.25}));
}

TEST_F(SdfSensor, RefusesTooManyRays) {
  EXPECT_NO_THROW(read(with_scan(axis(2048, "-1", "1"), axis(128, "-1", "1"))));
  expect_error(refusal(request(with_scan(axis(2049, "-1", "1"), axis(128, "-1", "1")))),
               folder_.path("uav.sdf"), 28, "<ray> of sensor 'nose'");
}

TEST_F(SdfSensor, WarnsOfADistortionAboutAnotherCentre) {
  EXPECT_THAT(warnings(with(kUav, "<p2>", "<center>0.5 0.5</center><p2>")), IsEmpty());
  EXPECT_THAT(warnings(with(kUav, "<p2>", "<center>0.5 0.4</center><p2>")),
              ElementsAre(HasSubstr("uav.sdf:25: <center> of sensor 'eye'")));
}

std::string with_imu_noise(const std::string& noise) {
  return with(kUav, "</link>",
              "<sensor name='imu' type='imu'><imu><angular_velocity><x>\n" + noise +
                  "</x></angular_velocity></imu></sensor></link>");
}

// SDF says a noise's type in an element for cameras and rangefinders, in an attribute for IMUs.
TEST_F(SdfSensor, NoiseOfTypeNoneIsNone) {
  const std::string model =
      with(with(with_imu_noise("<noise type='none'><mean>1</mean><stddev>2</stddev></noise>"),
                "<type>gaussian</type>", "<type>none</type>"),
           "<distortion>",
           "<noise><type>none</type><mean>1</mean><stddev>2</stddev></noise><distortion>");
  EXPECT_THAT(warnings(model), IsEmpty());
  const Uav uav = read(model);
  const auto expect_none = [](const Noise& noise) {
    EXPECT_EQ(noise.mean, 0.0);
    EXPECT_EQ(noise.stddev, 0.0);
  };
  expect_none(std::get<CameraModel>(uav.sensors.at(0).model).pixel_noise);
  expect_none(std::get<RangeModel>(uav.sensors.at(1).model).noise);
  expect_none(std::get<ImuModel>(uav.sensors.at(2).model).angular_velocity[0]);
}

TEST_F(SdfSensor, RefusesImuNoiseWithoutAType) {
  const Error error = refusal(request(with_imu_noise("<noise><stddev>0.1</stddev></noise>")));
  expect_error(error, folder_.path("uav.sdf"), 32, "");
  EXPECT_THAT(error.what(), HasSubstr("attribute[type]"));
}

TEST_F(SdfSensor, LeavesOutOtherSensorsWithAWarning) {
  const std::string model =
      with(kUav, "</link>", "<sensor name='bumper' type='contact'/>\n</link>");
  EXPECT_THAT(warnings(model), ElementsAre(HasSubstr("sensor 'bumper'")));
  EXPECT_EQ(read(model).sensors.size(), 2u);
}

using BadSensors = BadUavs;

TEST_F(BadSensors, AreRefused) {
  expect_refused({
      {"<horizontal_fov>1.5", "<horizontal_fov>3.2", 23, "<horizontal_fov> of sensor 'eye'"},
      {"<width>320", "<width>0", 24, "<width> of sensor 'eye'"},
      {"<width>320", "<width>4097", 24, "<width> of sensor 'eye'"},
      {"<height>240", "<height>-240", 24, "<height> of sensor 'eye'"},
      {"<near>0.1", "<near>30", 24, "<clip> of sensor 'eye'"},
      {"<near>0.1", "<near>0.00001", 24, "<near> of sensor 'eye'"},
      {"<k1>-0.2", "<k1>-2000", 25, "<k1> of sensor 'eye'"},
      {"<min>0.1", "<min>6", 29, "<range> of sensor 'nose'"},
      {"<stddev>0.25", "<stddev>-0.25", 30, "<stddev> of sensor 'nose'"},
      {"<update_rate>25", "<update_rate>-25", 22, "<update_rate> of sensor 'eye'"},
      {"type='ray'", "type='crystal_ball'", 27, "sensor 'nose'"},
  });
}

}  // namespace
}  // namespace tether::sim
