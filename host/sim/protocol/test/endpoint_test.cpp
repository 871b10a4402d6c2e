#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/sim_protocol/connection.h>

namespace tether::sim::protocol {
namespace {

using ::testing::HasSubstr;

TEST(Endpoint, IsAUnixSocketOrTcp) {
  EXPECT_EQ(parse_endpoint("unix:/run/sim.sock").value(), Endpoint("/run/sim.sock"));
  EXPECT_EQ(parse_endpoint("tcp://host:5300").value(), Endpoint(link::Address{"host", 5300}));
  EXPECT_EQ(parse_endpoint("tcp://[::1]:1").value(), Endpoint(link::Address{"::1", 1}));
}

TEST(Endpoint, IsWrittenAsItIsRead) {
  for (const std::string text : {"unix:/run/sim.sock", "tcp://host:5300", "tcp://[::1]:1"}) {
    EXPECT_EQ(to_string(parse_endpoint(text).value()), text);
  }
}

TEST(Endpoint, SaysWhatIsExpected) {
  for (const std::string text : {"", "gazebo", "unix:", "/run/sim.sock", "tcp:host:1"}) {
    const auto endpoint = parse_endpoint(text);
    ASSERT_FALSE(endpoint.ok()) << text;
    EXPECT_EQ(endpoint.failure().kind, Failure::Kind::kInvalid);
    EXPECT_THAT(endpoint.failure().message, HasSubstr("unix:/path/of/socket or tcp://host:port"));
  }
  EXPECT_THAT(parse_endpoint("tcp://host").failure().message, HasSubstr("no port"));
}

}  // namespace
}  // namespace tether::sim::protocol
