#pragma once

#include "support/trials.h"

#include <string>

#include <gtest/gtest.h>

namespace tether::system_test {

/// Companions (programs/companion_sut.cpp) fly squares through flight controllers.
class CompanionFlight : public testing::Test {
 protected:
  /// `controller` is the value of 'flight_controller'; the program computes `computing_ms` for each
  /// call. Returns the exit code.
  int fly(const std::string& controller, const std::string& computing_ms,
          const std::string& out = "out") {
    std::string uavs;
    for (int i = 0; i < uavs_; ++i)
      uavs += "[[uav]]\nname = \"uav" + std::to_string(i + 1) + "\"\nmodel = \"" + model_ +
              "\"\nposition_m = [" + std::to_string(3 * (i % 5)) + ", " +
              std::to_string(-3 * (i / 5)) + ", 0.1]\nflight_controller = " + controller + "\n";
    write_text(folder_ / "s.toml", "name = \"companion\"\nworld = \"yard\"\ntime_limit_s = 40\n" +
                                       uavs + R"([sut]
command = [")" COMPANION_SUT_PROGRAM R"(", "0", "1", ")" +
                                       gimbal_deg_ + R"("]
[[condition]]
name = "host"
policy = "conservative_barrier"
clock = "scripted"
computing_ms = )" + computing_ms + "\n[[metric]]\nkind = \"time_required\"\nuav = \"uav1\"\n");
    const Output output =
        run(tether({"run", folder_ / "s.toml", "--quiet", "--force", "--out", folder_ / out}));
    said_ = output.err;
    if (output.code <= 1) result_ = read_result(folder_ / out);
    return output.code;
  }

  TempFolder folder_;
  int uavs_ = 1;  ///< each with its companion, 3 m from each other
  std::string model_ = "hummingbird", gimbal_deg_ = "0";
  nlohmann::json result_;
  std::string said_;
};

}  // namespace tether::system_test
