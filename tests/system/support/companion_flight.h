#pragma once

#include "support/trials.h"

#include <string>

#include <gtest/gtest.h>

namespace tether::system_test {

/// A companion (programs/companion_sut.cpp) flies a square through a flight controller.
class CompanionFlight : public testing::Test {
 protected:
  /// `controller` is the value of 'flight_controller'; the program computes `computing_ms` for each
  /// call. Returns the exit code.
  int fly(const std::string& controller, const std::string& computing_ms,
          const std::string& out = "out") {
    write_text(folder_ / "s.toml", R"(name = "companion"
world = "yard"
time_limit_s = 40
[[uav]]
name = "uav1"
model = ")" + model_ + R"("
position_m = [0, 0, 0.1]
flight_controller = )" + controller + R"(
[sut]
command = [")" COMPANION_SUT_PROGRAM R"(", "0", "1", ")" +
                                       gimbal_deg_ + R"("]
[[condition]]
name = "host"
policy = "conservative_barrier"
clock = "scripted"
computing_ms = )" + computing_ms + "\n[[metric]]\nkind = \"time_required\"\n");
    const Output output =
        run(tether({"run", folder_ / "s.toml", "--quiet", "--force", "--out", folder_ / out}));
    said_ = output.err;
    if (output.code <= 1) result_ = read_result(folder_ / out);
    return output.code;
  }

  TempFolder folder_;
  std::string model_ = "hummingbird", gimbal_deg_ = "0";
  nlohmann::json result_;
  std::string said_;
};

}  // namespace tether::system_test
