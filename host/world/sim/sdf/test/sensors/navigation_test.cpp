#include "uav_folder.h"

#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/sim/geodesy.h>

namespace tether::sim {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

using SdfNavigation = UavModel;

const std::string kNoise = "<noise type='gaussian'><mean>0</mean><stddev>";
std::string noise(const std::string& stddev) {
  return kNoise + stddev + "</stddev></noise>";
}

/// kUav with one more sensor, which comes last.
std::string with_sensor(const std::string& type, const std::string& inside) {
  return with(kUav, "</link>",
              "<sensor name='more' type='" + type + "'><update_rate>5</update_rate>" + inside +
                  "</sensor></link>");
}

std::string navsat(const std::string& element) {
  const auto part = [](const std::string& across, const std::string& up) {
    return "<horizontal>" + noise(across) + "</horizontal><vertical>" + noise(up) + "</vertical>";
  };
  return "<" + element + "><position_sensing>" + part("1.5", "2.5") +
         "</position_sensing><velocity_sensing>" + part("0.1", "0.2") + "</velocity_sensing></" +
         element + ">";
}

TEST_F(SdfNavigation, ReadsAReceiverUnderBothOfItsNames) {
  for (const std::string type : {"navsat", "gps"}) {
    const Sensor sensor = read(with_sensor(type, navsat(type))).sensors.back();
    EXPECT_EQ(sensor.kind(), uav::SensorKind::kNavSat);
    EXPECT_EQ(sensor.update_rate_hz, 5.0);
    const auto& model = std::get<NavSatModel>(sensor.model);
    EXPECT_EQ(model.horizontal_m.stddev, 1.5);
    EXPECT_EQ(model.vertical_m.stddev, 2.5);
    EXPECT_EQ(model.horizontal_velocity_m_s.stddev, 0.1);
    EXPECT_EQ(model.vertical_velocity_m_s.stddev, 0.2);
  }
}

TEST_F(SdfNavigation, ReadsAMagnetometer) {
  const auto model = std::get<MagnetometerModel>(
      read(with_sensor("magnetometer", "<magnetometer><x>" + noise("1e-6") + "</x><z>" +
                                           noise("3e-6") + "</z></magnetometer>"))
          .sensors.back()
          .model);
  EXPECT_EQ(model.field_T[0].stddev, 1e-6);
  EXPECT_EQ(model.field_T[1].stddev, 0.0);
  EXPECT_EQ(model.field_T[2].stddev, 3e-6);
}

TEST_F(SdfNavigation, ReadsBarometersAndAltimeters) {
  const auto model_of = [&](const std::string& type, const std::string& inside) {
    return std::get<BarometerModel>(read(with_sensor(type, inside)).sensors.back().model);
  };
  const BarometerModel air = model_of(
      "air_pressure", "<air_pressure><reference_altitude>400</reference_altitude><pressure>" +
                          noise("3") + "</pressure></air_pressure>");
  EXPECT_EQ(air.pressure_Pa.stddev, 3.0);
  EXPECT_EQ(air.reference_altitude_m, 400.0);
  EXPECT_EQ(model_of("air_pressure", "<air_pressure/>").reference_altitude_m, std::nullopt);
  const BarometerModel altimeter =
      model_of("altimeter", "<altimeter><vertical_position>" + noise("0.5") +
                                "</vertical_position></altimeter>");
  EXPECT_NEAR(altimeter.pressure_Pa.stddev, 6.0, 0.01) << "12 Pa for each metre";
}

TEST_F(SdfNavigation, AnOdometryPluginIsASensor) {
  const std::string plugin =
      "<plugin filename='gz-sim-odometry-publisher-system' "
      "name='gz::sim::systems::OdometryPublisher'>";
  const std::string full = with(kUav, "</model>",
                                plugin +
                                    "<odom_publish_frequency>20</odom_publish_frequency>"
                                    "<gaussian_noise>0.3</gaussian_noise></plugin></model>");
  const Sensor sensor = read(full).sensors.back();
  EXPECT_EQ(sensor.name, "odometry");
  EXPECT_EQ(sensor.update_rate_hz, 20.0);
  EXPECT_EQ(std::get<OdometryModel>(sensor.model).position_m.stddev, 0.3);
  EXPECT_THAT(warnings(full), IsEmpty());
  EXPECT_EQ(
      read(with(kUav, "</model>", plugin + "</plugin></model>")).sensors.back().update_rate_hz,
      50.0);
  expect_error(refusal(request(with(full, "frequency>20<", "frequency>0<"))),
               folder_.path("uav.sdf"), 32, "plugin 'gz::sim::systems::OdometryPublisher'");
}

TEST_F(SdfNavigation, AReceiverNeedsAPlace) {
  const std::string model = with_sensor("navsat", navsat("navsat"));
  EXPECT_THAT(warnings(model), Contains(HasSubstr("no <spherical_coordinates>")));
  EXPECT_THAT(warnings(with_sensor("magnetometer", "<magnetometer/>")), IsEmpty());
}

// The world's x points north.
TEST_F(SdfNavigation, AWorldWithoutAFieldHasThatOfItsPlace) {
  const std::string place =
      "<spherical_coordinates><latitude_deg>60</latitude_deg><longitude_deg>10</longitude_deg>"
      "<heading_deg>-90</heading_deg></spherical_coordinates>";
  const World world = load({folder_.write("earth.sdf", world_sdf(place)), {}, {}}).world;
  EXPECT_EQ(to_enu(*world.place, world.magnetic_field_T), earth_field_T(*world.place));
  EXPECT_NEAR(world.magnetic_field_T.x, 15e-6, 2e-6);
}

TEST_F(SdfNavigation, ReadsThePlaceAndTheFieldOfTheWorld) {
  const auto load_with = [&](const std::string& inside) {
    return load({folder_.write("earth.sdf", world_sdf(inside)), {}, {}});
  };
  const std::string place =
      "<spherical_coordinates><surface_model>EARTH_WGS84</surface_model>"
      "<world_frame_orientation>ENU</world_frame_orientation><latitude_deg>-35.5</latitude_deg>"
      "<longitude_deg>149.25</longitude_deg><elevation>584</elevation>"
      "<heading_deg>90</heading_deg></spherical_coordinates>";
  const auto loaded = load_with(place + "<magnetic_field>1e-6 2e-6 -3e-6</magnetic_field>");
  EXPECT_THAT(loaded.warnings, IsEmpty());
  ASSERT_TRUE(loaded.world.place);
  EXPECT_NEAR(loaded.world.place->latitude_deg, -35.5, 1e-12);
  EXPECT_NEAR(loaded.world.place->longitude_deg, 149.25, 1e-12);
  EXPECT_EQ(loaded.world.place->elevation_m, 584.0);
  EXPECT_NEAR(loaded.world.place->heading_rad, 0.5 * std::numbers::pi, 1e-12);
  EXPECT_EQ(loaded.world.magnetic_field_T, (uav::Vec3{1e-6, 2e-6, -3e-6}));
  EXPECT_FALSE(load_with("").world.place);
  EXPECT_EQ(load_with("").world.magnetic_field_T, World{}.magnetic_field_T);
  EXPECT_THROW(load_with(with(place, "-35.5", "-95")), Error);
  EXPECT_THROW(load_with(with(place, ">ENU<", ">NED<")), Error);
}

}  // namespace
}  // namespace tether::sim
