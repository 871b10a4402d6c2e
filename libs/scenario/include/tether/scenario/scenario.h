#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <tether/base/time.h>
#include <tether/sim/world.h>
#include <tether/uav/sensor_timing.h>

/// Scenario files (TOML): everything that decides a run but the seed.
namespace tether::scenario {

enum class Policy { kConservativeBarrier, kFreeRunning };
enum class Clock { kWall, kCpu };

/// Where the SUT runs and how it is tied ("host", "target", "target, no sync").
struct Condition {
  std::string name;
  Policy policy = Policy::kConservativeBarrier;
  Clock clock = Clock::kCpu;
  double cpu_factor = 1.0;        ///< slowdown of the virtual target: seconds of ET per CPU second
  double real_time_factor = 0.0;  ///< limit on ST per WT; 0: none (free running: required, > 0)
};

struct UavSetup {
  sim::UavPlacement placement;
  std::map<std::string, uav::SensorTiming>
      sensors;  ///< by sensor name; one for each sensor of the model after resolve
  Duration command_latency{0};
};

/// The SUT's command; its parameters become `--key value` arguments (underscores as dashes).
struct Sut {
  std::vector<std::string> command;  ///< program and fixed arguments
  std::vector<std::pair<std::string, std::string>> parameters;
};

/// A number computed from the record's ground truth, with the limits within which the goal counts
/// as reached.
struct Metric {
  std::string name;            ///< unique; also the kind: "time_required", "oscillations", …
  std::string label;           ///< for tables
  std::string unit;            ///< "s", "m", "deg", "1"
  std::string anchor;          ///< of those that need one
  double threshold_rad = 0.0;  ///< oscillations: an overshoot beyond this counts
  std::optional<double> max;
};

struct Scenario {
  std::filesystem::path file;
  std::string name;
  std::string description;
  std::filesystem::path world;  ///< absolute
  Duration step{std::chrono::milliseconds(1)};
  Duration time_limit{0};                         ///< of ST
  Duration hang_limit{std::chrono::seconds(30)};  ///< of WT without a word from a SUT
  std::vector<UavSetup> uavs;                     ///< at least one
  std::vector<std::string> anchors;
  Sut sut;
  std::vector<Condition> conditions;  ///< at least one; the first is the default
  std::vector<Metric> metrics;
  Duration ground_truth_period{std::chrono::milliseconds(10)};
  bool record_images = false;

  /// nullptr where there is none of that name.
  const Condition* find_condition(const std::string& condition) const;
};

/// Reads and checks a scenario. Paths in it are relative to its own folder.
/// @throws Error(kBadFile) with file and line, saying what is wrong and what is allowed, for:
/// unknown key, wrong type, a
///   value out of its range, a missing file, a missing key.
Scenario load_scenario(const std::filesystem::path& file);

/// The world request of a scenario.
sim::WorldRequest world_request(const Scenario& scenario);

/// Each UAV's timing models in the order of its sensors in `world`; a sensor without one in the
/// scenario is periodic at its SDF update rate without delay, or on demand without delay where
/// there is no rate.
/// @throws Error(kBadFile) when the scenario times a sensor that the UAV does not have.
std::vector<std::vector<uav::SensorTiming>> resolve_timings(const Scenario& scenario,
                                                            const sim::World& world);

}  // namespace tether::scenario
