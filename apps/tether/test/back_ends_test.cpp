#include "back_ends.h"

#include <gtest/gtest.h>

#include <tether/base_testing/thrown_error.h>

namespace tether::app {
namespace {

TEST(BackEnds, HaveANameOrAnAddress) {
  EXPECT_FALSE(find_back_end("mujoco").reads_world);
  EXPECT_TRUE(find_back_end("gazebo").reads_world);
  for (const std::string address : {"unix:/run/sim.sock", "tcp://lab:4500", "tcp://[::1]:4500"})
    EXPECT_TRUE(find_back_end(address).files().empty()) << address;
  for (const std::string text :
       {"", "Gazebo", "unix:", "tcp://lab", "ssh://lab:22", "/run/sim.sock"})
    EXPECT_EQ(thrown_error(ErrorCode::kUsage, [&] { find_back_end(text); }).subject(), text);
}

}  // namespace
}  // namespace tether::app
