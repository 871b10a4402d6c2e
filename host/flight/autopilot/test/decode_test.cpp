#include <limits>

#include <gtest/gtest.h>

#include <tether/autopilot/flight_controller.h>
#include <tether/mavlink/frame.h>

namespace tether::autopilot {
namespace {

using mavlink::Message;

Bytes bytes_of(const Message& message) {
  return encode(message, {1, 1}, 0);
}

TEST(Decode, GivesFieldsByName) {
  const auto decoded = decode(bytes_of(
      Message("COMMAND_ACK").set("command", 400).set("result", 2).set("result_param2", -5)));
  ASSERT_EQ(decoded.size(), 1U);
  EXPECT_EQ(decoded[0].name, "COMMAND_ACK");
  EXPECT_EQ(decoded[0].fields_json,
            R"({"command":400,"result":2,"progress":0,"result_param2":-5,"target_system":0,)"
            R"("target_component":0})");
}

TEST(Decode, WritesWhatIsNoNumberAsNull) {
  const auto decoded =
      decode(bytes_of(Message("DEBUG_VECT")
                          .set("x", std::numeric_limits<double>::quiet_NaN())
                          .set("y", std::numeric_limits<double>::infinity())
                          .set("z", 0.1)
                          .set("time_usec", std::uint64_t{18'446'744'073'709'551'615U})
                          .set_text("name", "a\"b\\\n")));
  EXPECT_EQ(decoded.at(0).fields_json,
            R"({"time_usec":18446744073709551615,"x":null,"y":null,"z":0.1,"name":"a\"b\\\n"})");
}

TEST(Decode, WritesArraysAsArrays) {
  const auto decoded = decode(
      bytes_of(Message("ATTITUDE_TARGET").set("q", 1.0, 0).set("q", -0.5, 3).set("thrust", 1e-7)));
  EXPECT_NE(decoded.at(0).fields_json.find(R"("q":[1,0,0,-0.5])"), std::string::npos)
      << decoded[0].fields_json;
}

TEST(Decode, GivesAllMessagesOfADatagram) {
  Bytes two = bytes_of(Message("HEARTBEAT"));
  const Bytes second = bytes_of(Message("PING").set("seq", 1));
  two.insert(two.end(), second.begin(), second.end());
  const auto decoded = decode(two);
  ASSERT_EQ(decoded.size(), 2U);
  EXPECT_EQ(decoded[1].name, "PING");
}

TEST(Decode, AnythingElseIsOneEntryWithoutAName) {
  Bytes damaged = bytes_of(Message("PING"));
  damaged.back() ^= 1;
  for (const Bytes& bytes : {Bytes{}, Bytes(7, 0xFD), Bytes(1'000, 0x00), damaged}) {
    const auto decoded = decode(bytes);
    ASSERT_EQ(decoded.size(), 1U);
    EXPECT_EQ(decoded[0].name, "");
    EXPECT_EQ(decoded[0].fields_json, "{}");
  }
}

}  // namespace
}  // namespace tether::autopilot
