#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <tether/base/time.h>
#include <tether/scenario/metric.h>
#include <tether/sim/world.h>
#include <tether/uav/sensor_timing.h>

/// Scenario files (TOML): everything that decides a run but the seed. All values here are checked:
/// names are unique, files exist, numbers are in their ranges.
namespace tether::scenario {

enum class Policy { kConservativeBarrier, kFreeRunning };
enum class Clock { kWall, kCpu, kScripted };
/// As written in files: "conservative_barrier", "free_running".
std::string_view name(Policy policy);
/// As written in files: "wall", "cpu", "scripted".
std::string_view name(Clock clock);

/// Where the SUT runs and how it is tied: "host", "target", "target, no sync" (paper, Section V).
struct Condition {
  std::string name;
  std::string description;  ///< one line for a person; may be empty
  Policy policy = Policy::kConservativeBarrier;
  Clock clock = Clock::kCpu;
  double cpu_factor = 1.0;        ///< slowdown of the virtual target: seconds of ET per CPU second
  double real_time_factor = 0.0;  ///< limit on ST per WT; 0: none (free running: required, > 0)
  /// Of kScripted: what the SUT is charged for each phase of computing, whatever it took. > 0; such
  /// a run is the same every time. Of other clocks 0.
  Duration computing{0};
};

/// When a sensor measures, and where the scenario says so.
struct SensorSetup {
  uav::SensorTiming timing;
  int line = 0;  ///< in the scenario's file
};

/// The SUT's command; its parameters become `--key value` arguments (underscores as dashes). Those
/// that the scenario gives as files are absolute paths here.
/// A program with a '/' in its name is relative to the scenario's folder, and absolute here.
struct Sut {
  std::vector<std::string> command;  ///< program and fixed arguments; not empty
  std::vector<std::pair<std::string, std::string>> parameters;  ///< sorted by key
};

struct UavSetup {
  sim::UavPlacement placement;                 ///< model: absolute path
  double yaw_spread_rad = 0.0;                 ///< the start yaw of a trial lies within ± this
  std::map<std::string, SensorSetup> sensors;  ///< by name; those that the scenario times
  Duration command_latency{0};
  Sut sut;  ///< its own, or the scenario's; own parameters go over the scenario's
};

struct Scenario {
  std::filesystem::path file;  ///< absolute
  std::string name;            ///< letters, digits, '_', '-', '.'
  std::string description;
  std::filesystem::path world;  ///< absolute
  Duration step{std::chrono::milliseconds(1)};
  Duration time_limit{0};                         ///< of ST
  Duration hang_limit{std::chrono::seconds(30)};  ///< of WT without a word from a SUT
  std::vector<UavSetup> uavs;                     ///< at least one
  std::vector<std::string> anchors;
  std::vector<Condition> conditions;  ///< at least one; the first is the default
  std::vector<Metric> metrics;
  Duration ground_truth_period{std::chrono::milliseconds(10)};
  bool record_images = false;
  Duration image_period{0};  ///< least ST between two recorded images of one camera; 0: every one
  /// Every file that was named: the scenario itself, world, models, delay samples, the SUTs' files.
  /// Absolute, sorted.
  std::vector<std::filesystem::path> files;

  /// nullptr where there is none of that name.
  const Condition* find_condition(std::string_view condition) const;
};

/// A name as part of a file name: lower case, every run of other characters than letters and
/// digits one '-': "target, no sync" → "target-no-sync". Unique among a scenario's conditions.
std::string slug(std::string_view name);

/// Reads and checks a scenario (docs/guide/scenario.md). Paths in it are relative to its own
/// folder.
/// @throws Error(kBadFile) with file and line, saying what is wrong and what is allowed, for:
///   TOML errors, an unknown key, a wrong type, a value out of its range, a missing file or key.
Scenario load_scenario(const std::filesystem::path& file);

/// The world request of a trial: each UAV's start yaw is drawn from its spread, keyed by the seed.
sim::WorldRequest world_request(const Scenario& scenario, std::uint64_t seed);

/// Each UAV's timing models: one list per UAV of `world`, in the order of its sensors. A sensor
/// that the scenario does not time is periodic at its SDF update rate without delay, or on demand
/// without delay where SDF gives no rate.
/// @throws Error(kBadFile) when the scenario times a sensor that the UAV does not have, or asks for
/// a metric of one.
/// @pre `world` was loaded from `world_request(scenario, seed)`.
std::vector<std::vector<uav::SensorTiming>> resolve_timings(const Scenario& scenario,
                                                            const sim::World& world);

}  // namespace tether::scenario
