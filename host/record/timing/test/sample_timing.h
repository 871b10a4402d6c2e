#pragma once

#include <string>
#include <utility>
#include <vector>

#include <tether/base/random.h>
#include <tether/timing/timing.h>

namespace tether::timing {

/// Runs of a program that reads a camera, detects for about `detect_ns`, and commands.
inline Timing sample_timing(std::size_t runs = 2, std::size_t rounds = 30,
                            double detect_ns = 80e6) {
  Timing timing{.scenario = "face_anchor",
                .condition = "target",
                .program = "sut 1.0",
                .build_id = "0a",
                .builds = {{"uav1", {{"argument 1", "30"}, {"library libx.so", "0b"}}}},
                .board = "pi",
                .clock = "cpu",
                .recorded_at = "2026-11-20T10:00:00Z",
                .counted_ns = {},
                .runs = {}};
  for (std::size_t r = 0; r < runs; ++r) {
    Run run{"uav1", r + 1, {}};
    KeyedRandom random({r, 5, 0});
    const auto time = [&](double mean_ns) {
      return Duration(static_cast<std::int64_t>(mean_ns * (0.9 + 0.2 * random.uniform())));
    };
    for (std::size_t i = 0; i < rounds; ++i) {
      run.calls.push_back(
          {"camera", {{i == 0 ? "start to camera" : "command to camera", time(2e4)}}});
      run.calls.push_back(
          {"command", {{"camera to command", time(1e4)}, {"detect", time(detect_ns)}}});
    }
    timing.runs.push_back(std::move(run));
  }
  return timing;
}

}  // namespace tether::timing
