#pragma once

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/base_testing/thrown_error.h>

namespace tether::scenario {

/// As error_message, of Error(kBadFile).
template <class Action>
std::string bad_file_message(const Action& action) {
  return error_message(ErrorCode::kBadFile, action);
}

/// A scenario that uses every key, with the files that it names.
inline const std::string kFullScenario = R"(name = "full"
description = "every key"
world = "worlds/room.sdf"
step_ms = 2
time_limit_s = 60
hang_limit_s = 12.5
anchors = ["blue_box", "red_box"]

[[uav]]
name = "uav1"
model = "models/uav.sdf"
position_m = [1, -2.5, 1.2]
yaw_deg = 90
yaw_spread_deg = 2.5
command_latency_ms = 5
profile = "profiles/rig.toml"

[uav.sensors.camera]
timing = "periodic"
rate_hz = 30
phase_ms = 3
delay = { kind = "constant", ms = 37.4 }

[uav.sensors.imu]
timing = "periodic"
period_ms = 50
delay = { kind = "normal", mean_ms = 4, stddev_ms = 1.5 }

[uav.sensors.range]
timing = "on_demand"
delay = { kind = "empirical", file_ms = "delays.txt" }

[uav.sut]
command = ["own-sut", "--fast"]

[uav.sut.parameters]
anchor = "red_box"

[[uav]]
name = "uav2"
model = "models/uav.sdf"
position_m = [0, 0, 1]

[sut]
command = ["tether-sut", "face-anchor"]

[sut.parameters]
anchor = "blue_box"
precision_deg = 2.5
retries = 3
verbose = true

[sut.files]
mission = "missions/around.toml"

[[condition]]
name = "host"
description = "as it is"
policy = "conservative_barrier"
clock = "cpu"
cpu_factor = 1.5

[[condition]]
name = "target, no sync"
policy = "free_running"
clock = "wall"
real_time_factor = 0.25

[[condition]]
name = "scripted"
policy = "conservative_barrier"
clock = "scripted"
computing_ms = 2.5
profile = "profiles/fog.toml"

[[condition]]
name = "slow machine"
policy = "conservative_barrier"
target = "profiles/targets/slow.toml"
simulator = "gazebo"

[[metric]]
kind = "time_required"
uav = "uav1"
max_s = 30

[[metric]]
kind = "oscillations"
name = "swings"
label = "Swings"
uav = "uav2"
anchor = "red_box"
threshold_deg = 2
max = 0

[[metric]]
kind = "acquisition_time"
uav = "uav1"
sensor = "camera"

[record]
ground_truth_period_ms = 20
images = true
image_period_ms = 500
)";

inline const std::string kRigProfile = R"(name = "rig"

[sensors.camera]
kind = "camera"
timing = "on_demand"
noise = { stddev = 0.02 }
)";

inline const std::string kFogProfile = R"(name = "fog"

[sensors.range]
kind = "range"
max_m = 3
delay = { kind = "empirical", file_ms = "fog.txt" }
)";

inline const std::string kSlowTarget = R"(name = "slow"
clock = "cpu"
cpu_factor = 6
)";

/// Writes the scenario and the files that it names; returns the scenario's file.
inline std::filesystem::path write_project(const ScratchFolder& scratch,
                                           const std::string& scenario) {
  scratch.write("worlds/room.sdf", "<sdf/>");
  scratch.write("models/uav.sdf", "<sdf/>");
  scratch.write("delays.txt", "10\n20\n30.5\n");
  scratch.write("missions/around.toml", "");
  scratch.write("profiles/rig.toml", kRigProfile);
  scratch.write("profiles/fog.toml", kFogProfile);
  scratch.write("profiles/fog.txt", "90\n110\n");
  scratch.write("profiles/targets/slow.toml", kSlowTarget);
  return scratch.write("scenario.toml", scenario);
}

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

}  // namespace tether::scenario
