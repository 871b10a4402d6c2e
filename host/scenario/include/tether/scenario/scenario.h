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
#include <tether/scenario/clock.h>
#include <tether/scenario/metric.h>
#include <tether/scenario/profile.h>
#include <tether/scenario/target.h>
#include <tether/sim/world.h>
#include <tether/uav/sensor_timing.h>

/// Scenario files (TOML): everything that decides a run but the seed. All values here are checked:
/// names are unique, files exist, numbers are in their ranges.
namespace tether::scenario {

enum class Policy { kConservativeBarrier, kFreeRunning };
/// As written in files: "conservative_barrier", "free_running".
std::string_view name(Policy policy);

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
  /// Laid over every UAV's sensors in this order: its own, then what a campaign or the command line
  /// lays on top.
  std::vector<Profile> profiles{};
  /// Where the SUT runs; its clock and factor are those above. None: on this host.
  std::optional<Target> target{};
  /// What plays the world: "mujoco" or "gazebo"; a program may lay the address of another one over
  /// that.
  std::string simulator = "mujoco";
};

/// The SUT's command; its parameters become `--key value` arguments (underscores as dashes). Those
/// that the scenario gives as files are absolute paths here.
/// A program with a '/' in its name is relative to the scenario's folder, and absolute here.
struct Sut {
  std::vector<std::string> command;  ///< program and fixed arguments; not empty
  std::vector<std::pair<std::string, std::string>> parameters;  ///< sorted by key
  /// Several threads or processes of it talk to the UAV, or compute while another waits: it runs
  /// under tether-exec. Needs Clock::kWall.
  bool concurrent = false;
};

struct UavSetup {
  sim::UavPlacement placement;                   ///< model: absolute path
  double yaw_spread_rad = 0.0;                   ///< the start yaw of a trial lies within ± this
  std::optional<Profile> profile;                ///< laid over SDF's sensors
  std::map<std::string, SensorProfile> sensors;  ///< by name; laid over the profile
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
  /// Every file that was named: the scenario itself, world, models, profiles, delay samples, the
  /// SUTs' files. Absolute, sorted.
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

/// Lays the profile on top of all that the scenario says of its sensors, under each condition.
void lay_profile(Scenario& scenario, const Profile& profile);

/// Why the condition's SUTs cannot run on that target; empty: they can.
std::string why_not_on(const Condition& condition, const Target& target);

/// Has the condition's SUTs run there: what it said of their clock is replaced.
/// @throws Error(kUsage) with the reason of `why_not_on`.
void place_on(Condition& condition, Target target);

/// @throws Error(kBadFile) naming the UAV, if the condition measures by a clock that is no time
/// line for its SUT: of a concurrent one, any but Clock::kWall.
void require_clock(const Scenario& scenario, const Condition& condition);

/// The names of the profiles in use, each once, in the order of their layers: the UAVs', then the
/// condition's. One that is in several layers stands where the topmost of them is.
std::vector<std::string> profile_names(const Scenario& scenario, const Condition& condition);

/// Lays over the sensors of `world` what profiles and scenario say of them, the later over the
/// earlier: SDF, the UAV's profile, its [uav.sensors.NAME], the condition's profiles. Returns each
/// UAV's timing models: one list per UAV of `world`, in the order of its sensors. A sensor that
/// nothing times is periodic at its SDF update rate without delay, or on demand without delay where
/// SDF gives no rate.
///
/// An entry of a profile is of the UAV's sensor of that name and kind; where there is none, of its
/// only sensor of that kind, unless another entry names that one; where there is none either,
/// `warn` gets a line.
/// @throws Error(kBadFile) with file and line when the scenario speaks of a sensor that the UAV
/// does not have, or asks for a metric of one; when an entry could be of several sensors, two of
/// one, or has keys of another kind; when what comes of the layers excludes itself (a rangefinder's
/// minimum that is not below its maximum, a camera that exposes for longer than its period).
/// @pre `world` was loaded from `world_request(scenario, seed)`; `condition` is of `scenario`.
std::vector<std::vector<uav::SensorTiming>> resolve_sensors(const Scenario& scenario,
                                                            const Condition& condition,
                                                            sim::World& world,
                                                            const sim::WarningSink& warn);

}  // namespace tether::scenario
