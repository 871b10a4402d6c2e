#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <tether/base/error.h>
#include <tether/base/time.h>
#include <tether/computer/clock.h>
#include <tether/energy/meter.h>
#include <tether/mission/mission.h>
#include <tether/radio/settings.h>
#include <tether/scenario/metric.h>
#include <tether/scenario/profile.h>
#include <tether/scenario/target.h>
#include <tether/sim/world.h>
#include <tether/uav/sensor_timing.h>

namespace tether::autopilot {
struct External;
enum class GroundStation;
}  // namespace tether::autopilot

/// Scenario files (TOML): everything that determines a run except the seed. All values here are
/// checked: names are unique, files exist, numbers are in their ranges.
namespace tether::scenario {

// ---- What differs from flight to flight (docs/guide/scenario.md): the tables [vary.NAME].

struct Uniform {
  double least = 0.0, most = 0.0;
};
struct Normal {
  double mean = 0.0, stddev = 0.0;
};
struct OneOf {
  std::vector<double> values;  ///< at least one, equally probable
};
using Distribution = std::variant<Uniform, Normal, OneOf>;

/// A quantity of the world, and how it is drawn.
struct Variation {
  std::string name;      ///< of its table
  std::string quantity;  ///< "start_x_m", "mass_factor", "model_yaw_deg", …
  std::string of;        ///< the UAV, model or UAV.SENSOR; empty: each UAV, or the whole world
  Distribution distribution;
  FileLocation at;

  /// "start_x_m of uav1".
  std::string text() const;
};

/// The value that a flight got.
struct Varied {
  std::string name;
  std::string what;  ///< Variation::text
  double value = 0.0;

  friend bool operator==(const Varied&, const Varied&) = default;
};

/// Draws the values of a flight and changes `world` by them, but for mountings of sensors, which
/// profiles may replace: see `vary_mountings`. Models are placed again, up to 100 times, until they
/// touch nothing that they do not touch in the file, and UAVs until they start inside of nothing
/// new, nor below the floor; meshes are not looked at. The same seed always gives the same world.
/// `is_read_elsewhere`: an external simulator reads the world's file itself.
/// @throws Error(kBadFile) at the table: `of` names nothing, a value is impossible (a mass that is
///   not above 0, or that the rotors cannot lift), there is no room for a model or a UAV, or the
///   simulator would not see the change.
std::vector<Varied> vary(const std::vector<Variation>& variations, std::uint64_t seed,
                         bool is_read_elsewhere, sim::World& world);
/// Turns and moves the sensors. @pre after `resolve_sensors`
void vary_mountings(const std::vector<Variation>& variations, const std::vector<Varied>& values,
                    sim::World& world);

/// The flight controller of a UAV: to its program, the UAV is what it is behind that.
struct FlightController {
  const autopilot::External* external = nullptr;  ///< one that the user brings; nullptr: built-in
  std::filesystem::path path{};                   ///< of its build; absolute
  Duration boot{0};                               ///< of its time, at most, before the flight
  double link_baud = 0.0;        ///< of the line to the program; 0: bytes take no time
  Duration link_latency{0};      ///< each way
  bool starts_in_air = false;    ///< of the built-in one
  bool has_fixed_ports = false;  ///< flights with it cannot be parallel
  std::map<std::string, double> parameters{};
  autopilot::GroundStation ground_station{};  ///< what one may do; first: there is none
  std::uint16_t ground_station_port = 0;
  FileLocation at{};
  std::filesystem::path signing_key_file{};  ///< absolute; empty: the link is not signed
  std::string signing_key{};                 ///< its content
};

/// What a UAV needs to fly, and what its battery has (data/energy/*.toml).
struct Energy {
  std::filesystem::path file;  ///< absolute
  energy::Model model;         ///< without `battery` if the file has none
  bool has_battery = false;    ///< else the battery is that of the UAV's SDF file
  FileLocation rotor_at;
  FileLocation battery_at;  ///< of the file itself if it has none
};

/// Reads and checks an energy file (docs/guide/energy.md).
/// @throws Error(kBadFile) as `load_scenario`, also of a battery that cannot exist.
Energy load_energy(const std::filesystem::path& file);

enum class Policy { kConservativeBarrier, kFreeRunning };
/// As written in files: "conservative_barrier", "free_running".
std::string_view name(Policy policy);

/// Where the time of SUTs with computer::ClockKind::kReplayed comes from.
struct ReplaySource {
  std::filesystem::path timing;  ///< a timing file; absolute
  computer::ReplayMode mode = computer::ReplayMode::kResampled;
  computer::UnknownStages unknown = computer::UnknownStages::kRefused;
  /// A timing file of the program that flies, of a run under a counted clock; absolute; empty:
  /// none.
  std::filesystem::path counted{};
};
/// What one or more SUTs run on, and how their time is measured.
struct Computer {
  std::string name{};  ///< of [[target]]; empty: none describes it
  computer::Clock clock{computer::ClockKind::kCpu};
  std::optional<Target> target{};  ///< none: this host. Its clock is the one above
  int cores = 1;         ///< that several SUTs on it share; of a real one 0, they are not modelled
  bool by_hand = false;  ///< the user starts the SUTs on it
  FileLocation at{};
};

/// The computer on which the SUT of a UAV runs.
struct Seat {
  std::size_t computer = 0;          ///< index in Condition::computers
  std::optional<int> pinned_core{};  ///< on which only pinned SUTs run
};

/// Where the SUT runs and how it is synchronised: "host", "target", "target, no sync" (paper,
/// Section V).
struct Condition {
  std::string name;
  std::string description;  ///< one line for a person; may be empty
  Policy policy = Policy::kConservativeBarrier;
  double real_time_factor = 0.0;  ///< limit on ST per WT; 0: none (free running: required, > 0)
  std::optional<ReplaySource> replay{};    ///< with kReplayed
  std::optional<radio::Settings> radio{};  ///< replaces that of the scenario
  /// Applied to every UAV's sensors in this order: the condition's own, then that of a campaign or
  /// the command line.
  std::vector<Profile> profiles{};
  /// At least one. One without a seat: each UAV has such a computer of its own. Otherwise the
  /// scenario's [[target]]s. See `computer_of`.
  std::vector<Computer> computers = std::vector<Computer>(1);
  std::vector<Seat> seats{};  ///< by UAV, if they run on [[target]]s
  /// "mujoco" or "gazebo"; a program may replace it by the address of an external simulator.
  std::string simulator = "mujoco";
  /// Of a condition that was slowed down: what of the scenario it is, and the slowdown that the
  /// values above contain. Empty: it was not.
  std::string slowed_from{};
  /// The condition of the scenario that a target of the command line replaces. Empty: none does.
  std::string moved_from{};
  double slowdown = 1.0;
};

/// The SUT's command; its parameters become `--key value` arguments (underscores as dashes). Those
/// that the scenario gives as files are absolute paths here.
/// A program with a '/' in its name is relative to the scenario's folder, and absolute here.
struct Sut {
  std::vector<std::string> command;  ///< program and fixed arguments; not empty
  std::vector<std::pair<std::string, std::string>> parameters;  ///< sorted by key
  /// Several of its threads or processes communicate with the UAV, or compute while another waits:
  /// it runs under tether-exec. Needs computer::ClockKind::kWall.
  bool concurrent = false;
  /// What it flies, and by what the flight is judged; its file is the parameter "mission".
  std::optional<mission::Mission> mission{};
  /// It knows nothing of Tether: tether-exec --as-is makes its clocks, waits and ports those of the
  /// run.
  bool is_as_is = false;
  /// With is_as_is: so are all processes that it starts. Needs synchronisation, and
  /// computer::ClockKind::kCpu, with which they share one core, or kWall, with which they are
  /// stopped together.
  bool has_all_processes = false;
};

struct UavSetup {
  sim::UavPlacement placement;                   ///< model: absolute path
  double yaw_spread_rad = 0.0;                   ///< the start yaw of a trial lies within ± this
  std::optional<Profile> profile;                ///< overrides SDF's sensors
  std::map<std::string, SensorProfile> sensors;  ///< by name; override the profile
  uav::Delay command_latency{};
  std::optional<uav::SetpointLoss> setpoint_loss{};  ///< none: it keeps the last set-point
  std::optional<Energy> energy{};                    ///< none: energy is not simulated
  /// The [[target]] on which its program runs, in conditions without a clock or target of their
  /// own.
  std::optional<Seat> seat{};
  Sut sut;  ///< its own, or the scenario's; own parameters override the scenario's
  std::optional<FlightController> flight_controller{};  ///< none: the SUT commands the UAV itself
};

/// A model of the world, with those nested in it, that moves along a path, whatever it meets.
struct MovingModel {
  std::string model;
  uav::Path path;
  FileLocation at{};
};

/// What a UAV carries for a time.
struct CarriedPayload {
  std::string uav;  ///< empty: the only one
  sim::Payload payload;
  FileLocation at{};
};

/// Replaces a value of a scenario file.
struct Setting {
  /// Path of a key that the file has, from its top or from [[condition]] or [[uav]]:
  /// "time_limit_s", "condition.cpu_factor" or "cpu_factor", "sut.parameters.yaw_rate_deg_s". Or
  /// kUavCount.
  std::string key;
  std::string value;  ///< as on a command line

  friend bool operator==(const Setting&, const Setting&) = default;
};

/// The key of a setting that is in no file: the first so many UAVs of the file are flown.
inline constexpr std::string_view kUavCount = "uavs";

/// "KEY=VALUE", as an option. A VALUE that is a file in `folder` becomes an absolute path.
/// @throws Error(kUsage), about the text, if it has no key or no value.
Setting parse_setting(std::string_view text, const std::filesystem::path& folder);

/// No run is longer.
inline constexpr double kLongestRun_s = 7 * 24 * 3600.0;

/// Softer contacts are landings: UAVs descend at less.
inline constexpr double kHardContact_m_s = 0.5;
/// The same where a flight controller lands, at its own speed (MPC_LAND_SPEED).
inline constexpr double kHardLanding_m_s = 1.0;

struct Scenario {
  std::filesystem::path file;  ///< absolute
  std::string name;            ///< letters, digits, '_', '-', '.'; with settings, their values too
  std::string description;
  std::vector<Setting> settings{};                   ///< not of the file: values that were replaced
  std::filesystem::path world;                       ///< absolute
  sim::WorldOptions world_options{};                 ///< not of the file: how to read the world
  bool has_laid_profile = false;                     ///< not of the file: see lay_profile
  std::optional<Duration> step{};                    ///< none: that of the world
  FileLocation step_at{};                            ///< of its key; empty: there is none
  Duration time_limit{0};                            ///< of ST
  Duration hang_limit{std::chrono::seconds(30)};     ///< of WT without a message from a SUT
  Duration connect_limit{std::chrono::seconds(30)};  ///< of WT until every SUT has joined
  /// A contact that is harder misses the goal (record::Contact::speed_m_s); inf: none does.
  double max_contact_speed_m_s = kHardContact_m_s;
  std::vector<Computer> computers{};  ///< [[target]]s
  std::vector<UavSetup> uavs;         ///< at least one
  radio::Settings radio{};            ///< between them
  std::optional<uav::Wind> wind{};    ///< none: that of the world
  FileLocation wind_at{};
  std::vector<MovingModel> moving{};
  std::vector<CarriedPayload> payloads{};
  std::vector<Variation> variations{};  ///< what differs from flight to flight
  std::vector<std::string> anchors;
  FileLocation anchors_at{};          ///< of their key; empty: there is none
  std::vector<Condition> conditions;  ///< at least one; the first is the default
  std::vector<Metric> metrics;
  Duration ground_truth_period{std::chrono::milliseconds(10)};
  FileLocation ground_truth_at{};  ///< of its key; empty: there is none
  bool record_images = false;
  Duration image_period{0};  ///< least ST between two recorded images of one camera; 0: every one
  /// Every file that was named: the scenario itself, world, models, profiles, delay samples, the
  /// SUTs' files. Absolute, sorted.
  std::vector<std::filesystem::path> files;

  /// The line of the key in the file, if that has it once.
  FileLocation where(std::string_view key) const;
  /// nullptr if there is none of that name.
  const Condition* find_condition(std::string_view condition) const;
};

/// A name as part of a file name: lower case, every run of other characters than letters and
/// digits one '-': "target, no sync" → "target-no-sync". Unique among a scenario's conditions.
std::string slug(std::string_view name);

/// Reads and checks a scenario (docs/guide/scenario.md). Paths in it are relative to its own
/// folder. The settings replace values of the file; the scenario's name then becomes
/// "NAME-cpu_factor-2".
/// @throws Error(kBadFile) with file and line, about the key, for TOML errors, an unknown key, a
///   wrong type, a value out of its range, a missing file or key. Error(kUsage), about the key, if
///   a setting has a key that the file does not have. An error about the value of a setting has no
///   place; its message begins with `from` and the setting.
Scenario load_scenario(const std::filesystem::path& file, const std::vector<Setting>& settings = {},
                       const std::string& from = "--set ");

/// The start yaws that a seed draws.
std::vector<Varied> start_yaws(const Scenario& scenario, std::uint64_t seed);
/// The world request of a trial: each UAV's start yaw is drawn from its spread, keyed by the seed.
sim::WorldRequest world_request(const Scenario& scenario, std::uint64_t seed);

/// Makes the profile the topmost layer of the scenario's sensors, under each condition.
void lay_profile(Scenario& scenario, const Profile& profile);

/// The condition of that name; the scenario's first one if it is empty.
/// @throws Error(kUsage) about the name, with the nearest one, if there is none.
Condition pick_condition(const Scenario& scenario, const std::string& wanted);

/// The computer on which that UAV's SUT runs.
const Computer& computer_of(const Condition& condition, std::size_t uav);

/// What that computer draws: its target's power, else that of the UAV's energy file.
/// @pre the UAV has one.
const energy::Computer& power_of(const Scenario& scenario, const Condition& condition,
                                 std::size_t uav);

/// Whether several SUTs share the cores of that computer.
bool is_shared(const Condition& condition, std::size_t computer);

/// A real computer with the SUTs of several UAVs, which compete for its cores: they run and are
/// stopped together (DESIGN section 2, "Several programs on one board").
struct RealBoard {
  std::string name;               ///< of the computer, or the target
  std::vector<std::size_t> uavs;  ///< two at least
};
/// Those of a condition: computers with a wall clock that several UAVs name, and a board over SSH
/// on which all SUTs run. `uavs`: how many there are.
std::vector<RealBoard> real_boards(const Condition& condition, std::size_t uavs);

/// Makes the SUTs run on the computers that the scenario's UAVs name; each on one of its own
/// if not `shared`, and then the computers are named after the UAVs as well.
/// @throws Error(kBadFile), about the target, if SUTs cannot share one of the computers: because of
///   its clock, its cores or its address. @pre every UAV has a seat.
void seat(const Scenario& scenario, Condition& condition, bool shared);

/// The reason why the condition's SUTs cannot run on that target, each on one or as they share
/// their computers; empty: they can.
std::string why_not_on(const Condition& condition, const Target& target);

/// Makes the condition's SUTs run on the target, whose clock replaces that of the condition. If
/// there are several computers, each becomes such a target, and SUTs that share one still do.
/// @throws Error(kUsage), about the condition, with the reason of `why_not_on`.
void place_on(Condition& condition, const Target& target);

/// Changes what stages take that were not recorded: "refused", "counted" or "zero".
/// @throws Error(kUsage), about --unknown-stages, if the condition does not replay time, or cannot
/// so.
void set_unknown_stages(Condition& condition, std::string_view name);

/// Makes the condition's SUTs so many times slower: its factor, the computing time of a scripted
/// clock, or the costs of a counted one. The name becomes "NAME, 3.16 × slower".
/// @throws Error(kUsage), about the condition, if its SUTs' time cannot be stretched.
/// @pre slowdown > 0; it was not slowed down before.
void slow_down(Condition& condition, double slowdown);

/// @throws Error(kBadFile), about the UAV, if its SUT is concurrent and the condition's clock is
/// not computer::ClockKind::kWall.
void require_clock(const Scenario& scenario, const Condition& condition);

/// The names of the profiles in use, each once, in the order of their layers: the UAVs', then the
/// condition's. A profile in several layers is listed at the topmost one.
std::vector<std::string> profile_names(const Scenario& scenario, const Condition& condition);

/// Applies profiles and scenario to the sensors of `world`; a later layer overrides an earlier one:
/// SDF, the UAV's profile, its [uav.sensors.NAME], the condition's profiles. Returns the timing
/// models: one list per UAV of `world`, in the order of its sensors. A sensor without a timing is
/// periodic at its SDF update rate without delay, or on demand without delay if SDF gives no rate.
///
/// An entry of a profile applies to the UAV's sensor of that name and kind; if there is none, to
/// its only sensor of that kind, unless another entry names that one. Otherwise `warn` gets a line.
/// @throws Error(kBadFile) with file and line, about the sensor or key, if the scenario or one of
/// its metrics names a sensor that the UAV does not have; if an entry matches several sensors, or
/// two entries one sensor; if a key is not supported by the sensor's kind; or if the resulting
/// values exclude each other (a rangefinder's minimum that is not below its maximum, a camera with
/// an exposure longer than its period); or if a periodic sensor would measure more than once in a
/// step. Where the step makes the time between two measurements vary by more than a tenth, `warn`
/// gets a line as well.
/// @pre `world` was loaded from `world_request(scenario, seed)`; `condition` is of `scenario`.
std::vector<std::vector<uav::SensorTiming>> resolve_sensors(const Scenario& scenario,
                                                            const Condition& condition,
                                                            sim::World& world,
                                                            const sim::WarningSink& warn);

/// Gives `world` the scenario's wind, if it has one, and its models their paths, with those that
/// are nested in them. `is_read_elsewhere`: an external simulator reads the world's file itself.
/// @throws Error(kBadFile) at the table: it names no model, or the simulator would not simulate it.
void resolve_motion(const Scenario& scenario, bool is_read_elsewhere, sim::World& world);

/// Gives `world` the scenario's step, if it has one.
/// @throws Error(kBadFile) at the key if the scenario's period of the ground truth is shorter than
/// the step. @pre as of `resolve_sensors`.
void resolve_step(const Scenario& scenario, sim::World& world);

/// What a flight with this seed makes of a world: everything below, in the order that they need.
struct Resolved {
  std::vector<std::vector<uav::SensorTiming>> timings;  ///< of `resolve_sensors`
  std::vector<Varied> varied;
};
Resolved resolve_world(const Scenario& scenario, const Condition& condition, std::uint64_t seed,
                       bool is_read_elsewhere, sim::World& world, const sim::WarningSink& warn);

/// Gives the UAVs of `world` their models of energy, with the power of the condition's computer.
/// @throws Error(kBadFile) with file and line, about "rotor" or "battery", if the battery cannot
/// lift its UAV, or there is none.
/// @pre as of `resolve_sensors`.
void resolve_energy(const Scenario& scenario, const Condition& condition, sim::World& world,
                    const sim::WarningSink& warn);

}  // namespace tether::scenario
namespace tether::scenario {

/// For questions that flights with a goal reached or missed answer: requires a limit of a metric
/// that flights can miss, or a mission with a deadline or a clause. The SUT's own goal alone is not
/// enough: it says that the program ended as planned, not when or how well.
/// @throws Error(kBadFile) about the limit or "metric", with the line if there is a metric.
void require_decidable(const Scenario& scenario);

/// How many times as long a target computes as the computer of a condition of the scenario.
struct Slowness {
  double factor = 1.0;
  std::optional<std::pair<double, double>> bounds{};  ///< none: not known
};

/// By the factors of their clocks. Of counted targets, by their costs: the bounds are the least and
/// the greatest ratio of the costs of one kind of work, so that they hold for every program.
/// @throws Error(kUsage) about the target's file, if the two cannot be compared, or differ in more
/// than in speed: in their launcher or, where energy is simulated, in their power.
Slowness slowness(const Target& target, const Scenario& scenario, const Condition& condition);

}  // namespace tether::scenario
