#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <tether/mavlink/message.h>

namespace tether::mavlink {
namespace {

TEST(Message, KeepsEveryBitOfALongInteger) {
  Message m("HIL_SENSOR");
  constexpr std::uint64_t kLong = 0xFEDC'BA98'7654'3211U;
  m.set("time_usec", kLong);
  EXPECT_EQ(static_cast<std::uint64_t>(m.integer("time_usec")), kLong);
  Message sync("TIMESYNC");
  sync.set("tc1", std::int64_t{-9'007'199'254'740'993});
  EXPECT_EQ(sync.integer("tc1"), -9'007'199'254'740'993);
}

TEST(Message, BringsNumbersIntoTheRangeOfTheirField) {
  Message m("COMMAND_ACK");
  EXPECT_EQ(m.set("command", 70'000).integer("command"), 65'535);
  EXPECT_EQ(m.set("command", -3.0).integer("command"), 0);
  EXPECT_EQ(m.set("command", 2.6).integer("command"), 3);
  EXPECT_EQ(m.set("command", std::nan("")).integer("command"), 0);
  EXPECT_EQ(m.set("result_param2", 1e300).integer("result_param2"), 2'147'483'647);
  EXPECT_EQ(
      m.set("result_param2", std::numeric_limits<std::uint64_t>::max()).integer("result_param2"),
      2'147'483'647);
}

TEST(Message, HasTextsAndArrays) {
  Message m("STATUSTEXT");
  EXPECT_EQ(m.set_text("text", "landed").text("text"), "landed");
  EXPECT_EQ(m.set_text("text", std::string(80, 'x')).text("text"), std::string(50, 'x'));
  Message attitude("SET_ATTITUDE_TARGET");
  attitude.set("q", 0.5, 3);
  EXPECT_EQ(attitude.number("q", 3), 0.5);
  EXPECT_EQ(attitude.number("q", 0), 0.0);
}

TEST(Message, FieldsAreBesideEachOther) {
  for (const MessageType& type : message_types()) {
    Message m(type);
    const auto for_each = [&](auto visit) {
      int value = 0;
      for (const Field& field : type.fields)
        for (std::size_t i = 0; i < field.count; ++i) visit(field.name, i, value = value % 126 + 1);
    };
    for_each([&](auto name, std::size_t i, int value) { m.set(name, value, i); });
    for_each([&](auto name, std::size_t i, int value) {
      EXPECT_EQ(m.integer(name, i), value) << type.name << " " << name;
      EXPECT_EQ(m.number(name, i), value) << type.name << " " << name;
    });
    EXPECT_EQ(std::ranges::count(m.payload(), 0) > 0,
              std::ranges::any_of(type.fields, [](const Field& f) { return size_of(f.type) > 1; }));
  }
}

TEST(MessageDeathTest, AFieldThatTheTypeLacksIsAFaultOfTheProgram) {
  Message m("HEARTBEAT");
  EXPECT_DEATH(m.set("altitude", 1), "no MAVLink field");
  EXPECT_DEATH(Message("NOTHING"), "no MAVLink message");
}

}  // namespace
}  // namespace tether::mavlink
