#include "parameters.h"

#include "flight.h"

#include <bit>

namespace tether::autopilot {
namespace {

constexpr int kInt32 = 6, kReal32 = 9;

Message set(const char* name, float value, int type = kReal32) {
  return Message("PARAM_SET")
      .set("target_system", 1)
      .set("target_component", 1)
      .set_text("param_id", name)
      .set("param_value", value)
      .set("param_type", type);
}
Message read(const char* name, int index = -1) {
  return Message("PARAM_REQUEST_READ")
      .set("target_system", 1)
      .set("target_component", 1)
      .set_text("param_id", name)
      .set("param_index", index);
}
std::int32_t whole_of(const Message& m) {
  return std::bit_cast<std::int32_t>(static_cast<float>(m.number("param_value")));
}

TEST(Parameters, AreSortedByName) {
  EXPECT_TRUE(std::ranges::is_sorted(parameter_infos(), {}, &ParameterInfo::name));
  EXPECT_EQ(parameter_infos().size(), static_cast<std::size_t>(Parameter::kReturnAltitude_m) + 1);
  EXPECT_EQ(info_of(Parameter::kCruise_m_s).name, "MPC_XY_CRUISE");
  EXPECT_EQ(info_of(Parameter::kOffboardLoss_s).name, "COM_OF_LOSS_T");
  for (const ParameterInfo& info : parameter_infos()) {
    EXPECT_LE(info.name.size(), 16U);
    EXPECT_TRUE(complaint_about_parameter(std::string(info.name), info.initial).empty());
  }
}

TEST(Parameters, ComplainAboutNamesAndValues) {
  EXPECT_NE(complaint_about_parameter("MPC_XY", 1.0).find("COM_OF_LOSS_T"), std::string::npos);
  EXPECT_EQ(complaint_about_parameter("MPC_XY_CRUISE", 50.0), "is 50; it must be from 0.5 to 20.");
  EXPECT_NE(complaint_about_parameter("MPC_XY_CRUISE", kNone), "");
  EXPECT_NE(complaint_about_parameter("COM_LOW_BAT_ACT", 1.5), "") << "it is a whole number";
}

TEST(Parameters, AreListed) {
  Flight flight;
  flight.boot();
  flight.heard.clear();
  flight.send(Message("PARAM_REQUEST_LIST").set("target_system", 1));
  flight.run(0.2);
  const std::size_t count = parameter_infos().size();
  ASSERT_EQ(flight.count("PARAM_VALUE"), count);
  std::size_t index = 0;
  for (const Message& m : flight.heard) {
    if (!m.is("PARAM_VALUE")) continue;
    const ParameterInfo& info = parameter_infos()[index];
    EXPECT_EQ(m.text("param_id"), info.name);
    EXPECT_EQ(static_cast<std::size_t>(m.integer("param_index")), index++);
    EXPECT_EQ(static_cast<std::size_t>(m.integer("param_count")), count);
    EXPECT_EQ(m.integer("param_type"), info.is_integer ? kInt32 : kReal32);
    if (info.is_integer)
      EXPECT_EQ(whole_of(m), std::lround(info.initial));
    else
      EXPECT_FLOAT_EQ(static_cast<float>(m.number("param_value")),
                      static_cast<float>(info.initial));
  }
}

TEST(Parameters, AreReadByNameAndNumber) {
  Flight flight;
  flight.boot();
  flight.heard.clear();
  flight.send(read("MPC_XY_CRUISE"));
  flight.send(read("", 2));
  for (const Message& nothing : {read("NO_SUCH"), read("", 500), read("MPC_XY_CRUIS")})
    flight.send(nothing);
  flight.run(0.01);
  EXPECT_EQ(flight.count("PARAM_VALUE"), 2U);
  EXPECT_EQ(flight.last("PARAM_VALUE")->text("param_id"), "BAT_LOW_THR");
}

TEST(Parameters, AreSetAndWithinTheirLimits) {
  Flight flight;
  flight.boot();
  const auto answer = [&](const Message& m) {
    flight.heard.clear();
    flight.send(m);
    flight.run(0.004);
    EXPECT_NE(flight.last("PARAM_VALUE"), nullptr);
    return *flight.last("PARAM_VALUE");
  };
  EXPECT_EQ(answer(set("MPC_XY_CRUISE", 2.5F)).number("param_value"), 2.5);
  EXPECT_EQ(answer(set("MPC_XY_CRUISE", 1e30F)).number("param_value"), 20.0);
  EXPECT_EQ(answer(set("MPC_XY_CRUISE", std::nanf(""))).number("param_value"), 20.0);
  EXPECT_EQ(whole_of(answer(set("COM_OBL_RC_ACT", std::bit_cast<float>(4), kInt32))), 4);
  EXPECT_EQ(whole_of(answer(set("COM_OBL_RC_ACT", std::bit_cast<float>(-1), kInt32))), 0);
  EXPECT_EQ(whole_of(answer(set("COM_OBL_RC_ACT", 3.0F, kReal32))), 0) << "of another type";
  EXPECT_TRUE(flight.was_said("parameter not set"));
  flight.heard.clear();
  flight.send(set("NO_SUCH", 1.0F));
  flight.run(0.004);
  EXPECT_EQ(flight.count("PARAM_VALUE"), 0U);
}

TEST(Parameters, HaveAnEffectAtOnce) {
  Flight flight;
  flight.boot();
  flight.send(set("MIS_TAKEOFF_ALT", 5.0F));
  flight.take_off();
  EXPECT_NEAR(flight.body.p_WB.z, 5.0, 0.35);
}

}  // namespace
}  // namespace tether::autopilot
