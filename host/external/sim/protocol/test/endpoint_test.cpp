#include <gtest/gtest.h>

#include <tether/sim_protocol/connection.h>

namespace tether::sim::protocol {
namespace {

TEST(Endpoint, IsAUnixSocketOrTcp) {
  EXPECT_EQ(parse_endpoint("unix:/run/sim.sock").value(), Endpoint("/run/sim.sock"));
  EXPECT_EQ(parse_endpoint("tcp://host:5300").value(), Endpoint(link::Address{"host", 5300}));
  for (const std::string text : {"unix:/run/sim.sock", "tcp://host:5300", "tcp://[::1]:1"}) {
    EXPECT_EQ(to_string(parse_endpoint(text).value()), text);
  }
  for (const std::string text :
       {"", "gazebo", "unix:", "/run/sim.sock", "tcp:host:1", "tcp://host"}) {
    EXPECT_EQ(parse_endpoint(text).failure().kind, Failure::Kind::kInvalid) << text;
  }
}

}  // namespace
}  // namespace tether::sim::protocol
