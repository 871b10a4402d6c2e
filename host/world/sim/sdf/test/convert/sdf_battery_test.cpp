#include "uav_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::sim {
namespace {

using ::testing::IsEmpty;

using SdfBattery = UavModel;

std::string with_battery(const std::string& parameters) {
  return with(kUav, "<link name='body'>",
              "<plugin filename='gz-sim-linearbattery-system' "
              "name='gz::sim::systems::LinearBatteryPlugin'>" +
                  parameters + "</plugin>\n<link name='body'>");
}

TEST_F(SdfBattery, IsThatOfGazebosPlugin) {
  const std::string model = with_battery(
      "<battery_name>b</battery_name><voltage>12.694</voltage>"
      "<open_circuit_voltage_constant_coef>12.694</open_circuit_voltage_constant_coef>"
      "<open_circuit_voltage_linear_coef>-3.1424</open_circuit_voltage_linear_coef>"
      "<initial_charge>1.0</initial_charge><capacity>1.2009</capacity>"
      "<resistance>0.061523</resistance>");
  EXPECT_THAT(warnings(model), IsEmpty());
  const auto battery = read(model).battery;
  ASSERT_TRUE(battery);
  EXPECT_DOUBLE_EQ(battery->capacity_C, 3600.0 * 1.2009);
  EXPECT_DOUBLE_EQ(battery->initial_charge, 1.0 / 1.2009);
  EXPECT_DOUBLE_EQ(open_circuit_voltage_V(*battery, 1.0), 12.694);
  EXPECT_DOUBLE_EQ(open_circuit_voltage_V(*battery, 0.0), 12.694 - 3.1424);
  EXPECT_DOUBLE_EQ(battery->resistance_ohm, 0.061523);
}

TEST_F(SdfBattery, OfGazebo11IsKnownByItsFile) {
  const std::string model =
      with(kUav, "<link name='body'>",
           "<plugin name='pack' filename='libLinearBatteryPlugin.so'><link_name>body</link_name>"
           "<capacity>2</capacity>\n"
           "<open_circuit_voltage_constant_coef>12</open_circuit_voltage_constant_coef>"
           "<smooth_current_tau>1.9</smooth_current_tau></plugin>\n<link name='body'>");
  EXPECT_DOUBLE_EQ(read(model).battery.value().capacity_C, 7200.0);
  const std::vector<Warning> all = load(request(model)).warnings;
  ASSERT_EQ(all.size(), 1U);
  EXPECT_THAT(all[0].subject, ::testing::HasSubstr("smooth_current_tau"));
}

TEST_F(SdfBattery, IsMissingWithoutThePlugin) {
  EXPECT_FALSE(read(kUav).battery);
}

using BadBatteries = BadUavs;

TEST_F(BadBatteries, AreRefused) {
  for (const char* bad : {"<voltage>12</voltage>", "<capacity>2</capacity>",
                          "<voltage>12</voltage><capacity>2</capacity><resistance>-1</resistance>",
                          "<voltage>12</voltage><capacity>2</capacity>"
                          "<initial_charge>3</initial_charge>",
                          "<voltage>12</voltage><capacity>2</capacity>"
                          "<open_circuit_voltage_linear_coef>1</open_circuit_voltage_linear_coef>"})
    EXPECT_EQ(refusal(request(with_battery(bad))).where().line, 20) << bad;
}

}  // namespace
}  // namespace tether::sim
