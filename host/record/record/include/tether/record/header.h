#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tether/base/time.h>
#include <tether/computer/clock.h>

/// The header of a run's record: what its numbers depend on.
namespace tether::record {

inline constexpr int kSchemaVersion = 1;

/// Values of Header::policy.
inline constexpr std::string_view kConservativeBarrier = "conservative_barrier";
inline constexpr std::string_view kFreeRunning = "free_running";

/// Of uav::Path.
struct Waypoint {
  Duration at{0};
  double p_m[3] = {};
  double yaw_rad = 0.0;
};
/// An entity of the world that is known in advance (frame A), in the world frame W.
struct Anchor {
  std::string name;
  std::string shape;
  double size_m[3] = {};
  double p_WA_m[3] = {};  ///< of its centre, as the world's file places it
  double q_WA[4] = {1, 0, 0, 0};
  std::vector<Waypoint> path{};  ///< uav::Path of its model; empty: it stands still
  bool path_repeats = false;
  Duration path_delay{0};
  double p_WO_m[3] = {};  ///< about which the path turns it; only with a path
  std::string uav{};      ///< the UAV that it is; empty: a model of the world
  double p_BA_m[3] = {};  ///< of its centre in that UAV's body, whose axes are its own
};
/// Mounting and intrinsics of a camera, for projections into its images.
struct CameraInfo {
  /// Mounting in the UAV's body B, while its joints are at 0; S is body-style (x forward).
  double p_BS_m[3] = {};
  double q_BS[4] = {1, 0, 0, 0};
  int width_px = 0;  ///< 1 to 100 000, as the height
  int height_px = 0;
  double fx_px = 0, fy_px = 0;  ///< focal lengths, > 0
  double cx_px = 0, cy_px = 0;  ///< principal point, from the centre of the upper left pixel
  double k1 = 0, k2 = 0, k3 = 0, p1 = 0, p2 = 0;  ///< Brown-Conrady distortion, as in SDF
  double depth_min_m = 0, depth_max_m = 0;        ///< 0: measures no depths
  std::vector<std::string> models{};  ///< of a segmentation camera: those that labels 1, 2, … show
  std::uint64_t joints = 0;           ///< it is behind so many of SutInfo::joints
};
/// How the driver of a sensor stamps and delivers its samples.
struct DriverInfo {
  Duration stamp_offset{0};
  Duration stamp_jitter{0};           ///< standard deviation
  int stamp_drift_ppb = 0;            ///< what the clock of its stamps gains
  double lost_probability = 0.0;      ///< [0, 1)
  double repeated_probability = 0.0;  ///< [0, 1)

  friend bool operator==(const DriverInfo&, const DriverInfo&) = default;
};
struct SensorInfo {
  std::string uav;
  std::string name;
  /// "camera", "depth camera", "rgbd camera", "segmentation camera", "imu", "range"
  std::string kind;
  bool periodic = false;
  Duration period{0};
  Duration phase{0};
  /// Bounds of the delay model (available_at − sampled_at), both inclusive.
  Duration delay_min{0};
  Duration delay_max{Duration::max()};
  std::optional<CameraInfo> camera{};  ///< none in records of Tether 0.1.0
  std::optional<DriverInfo> driver{};  ///< none: each sample is delivered once, with its instant
};
/// Where the time of a SUT with the clock "replayed" comes from.
struct ReplayInfo {
  std::string timing;       ///< name of the timing file
  std::string mode;         ///< "exact", "resampled", "scaled"
  std::string recorded_at;  ///< when the newest of its records was made: UTC as in ISO 8601
  std::string board;        ///< on which
  std::string build_id;     ///< of the program that was timed; empty: not known

  friend bool operator==(const ReplayInfo&, const ReplayInfo&) = default;
};
/// For a person: "replayed (exact) from FILE, recorded AT on BOARD".
inline std::string describe(const ReplayInfo& from) {
  return "replayed (" + from.mode + ") from " + from.timing + ", recorded " + from.recorded_at +
         " on " + from.board;
}
struct ChargeVoltage {
  double charge = 0.0;  ///< share of the capacity
  double voltage_V = 0.0;

  friend bool operator==(const ChargeVoltage&, const ChargeVoltage&) = default;
};
/// The model of a UAV's energy: its battery, and what draws from it.
struct EnergyInfo {
  double capacity_C = 0.0;  ///< [A s]; > 0
  double resistance_ohm = 0.0;
  double initial_charge = 1.0;                   ///< share of the capacity
  std::vector<ChargeVoltage> voltage_at_charge;  ///< open circuit; both rise; linear in between
  double lift_W = 0.0;                           ///< what hovering takes
  double idle_W = 0.0;
  double busy_core_W = 0.0;
  double sensors_W = 0.0;

  friend bool operator==(const EnergyInfo&, const EnergyInfo&) = default;
};
/// One of the things besides the program's own code that decide what it computes, see
/// link::BuildPart.
struct BuildPart {
  std::string name;
  std::string value;

  friend bool operator==(const BuildPart&, const BuildPart&) = default;
};
/// The flight controller of a UAV, and its link to the SUT.
struct ControllerInfo {
  std::string name;
  std::string estimate;      ///< what it flies on: a sensor, or "truth"
  Duration period{0};        ///< of its steps; > 0
  double link_baud = 0.0;    ///< 10 bits for each byte; 0: bytes take no time
  Duration link_latency{0};  ///< each way

  friend bool operator==(const ControllerInfo&, const ControllerInfo&) = default;
};
/// A joint of a UAV (uav::Joint).
struct JointInfo {
  std::string name;
  double p_BJ_m[3] = {};
  double axis_B[3] = {};
  double min_rad = 0.0, max_rad = 0.0;
  double max_rate_rad_s = 0.0;

  friend bool operator==(const JointInfo&, const JointInfo&) = default;
};
/// What a UAV carries for a time, at its centre of mass.
struct PayloadInfo {
  double mass_kg = 0.0;            ///< > 0
  SimTime from{};                  ///< the first step with it begins here or later
  SimTime until = SimTime::max();  ///< the first step without it begins here or later

  friend bool operator==(const PayloadInfo&, const PayloadInfo&) = default;
};
/// What a UAV carries from when to when, and what is needed to know how that slows it.
struct LoadInfo {
  double own_mass_kg = 0.0;   ///< without them; > 0
  double gravity_m_s2 = 0.0;  ///< its share of SutInfo::max_acceleration_m_s2
  std::vector<PayloadInfo> payloads;

  friend bool operator==(const LoadInfo&, const LoadInfo&) = default;
};
struct SutInfo {
  std::string uav;
  std::string sut;  ///< name and version that the SUT reported
  computer::Clock clock{};
  /// From a command's timestamp to its effect, before rounding; the least if it is drawn.
  Duration command_latency{0};
  bool concurrent = false;  ///< several threads with parallel calls
  /// Clock "cpu": number of cores whose CPU time can add up; 0: unknown.
  int cores = 0;
  /// The most that rotors and gravity together can accelerate the UAV, without `load`; 0: unknown,
  /// as in records of Tether 0.1.0.
  double max_acceleration_m_s2 = 0.0;
  /// The clock of the condition; the SUT announced the one above. None in records of Tether 0.1.0.
  std::optional<computer::Clock> required_clock{};
  std::string build_id{};              ///< of the program; empty: it has none
  std::vector<BuildPart> build{};      ///< empty in records of Tether 0.1.0: not known
  std::optional<ReplayInfo> replay{};  ///< clock "replayed"
  std::string board{};  ///< Header::boards: the computer that it shares; empty: one of its own
  std::optional<int> pinned_core{};  ///< of that computer; only pinned programs run there
  /// Name of the scenario's computer on which the SUT runs, shared or not. Empty: the scenario
  /// describes none, or it is a record of Tether 0.1.0.
  std::string computer{};
  std::string launcher{};  ///< words of the target before the SUT's command; empty: none
  /// Of the UAV's collision shapes: how far they reach from the origin of B. 0: unknown.
  double extent_m = 0.0;
  /// The most that the rotors can change its rate of rotation; 0: unknown.
  double max_angular_acceleration_rad_s2 = 0.0;
  std::optional<EnergyInfo> energy{};  ///< none: energy is not simulated, or Tether 0.1.0
  std::optional<Duration> max_command_latency{};  ///< none: it is constant
  Duration setpoint_timeout{0};                   ///< 0: there is none
  std::string on_setpoint_loss{};                 ///< with a timeout: "keep", "hover", …
  std::optional<ControllerInfo> controller{};     ///< none: its commands are the vehicle's own
  bool as_is = false;  ///< it does not use Tether's library: tether-exec --as-is runs it
  std::vector<JointInfo> joints{};
  std::optional<LoadInfo> load{};  ///< none: it carries nothing
};
/// A computer whose cores several SUTs share. On a virtual one, while n compute, each gets min(1,
/// cores / n) of a core; a core with pinned programs is shared by these only. On a real one, its
/// operating system shares the cores, and all of its SUTs stop together.
struct BoardInfo {
  std::string name;
  int cores = 1;         ///< of a real one 0
  bool is_real = false;  ///< not in records of Tether 0.1.0

  friend bool operator==(const BoardInfo&, const BoardInfo&) = default;
};
/// Readings of a machine by name, see host/trial/board/src/target_probe.sh: "governor",
/// "temperature_mc", … Values that are not available are left out.
using Readings = std::map<std::string, std::string>;
/// The machine that the SUTs ran on.
struct TargetInfo {
  std::string name;
  std::string address;  ///< "ssh://user@board"; empty: the host
  Readings before;      ///< before the first SUT was started
};
/// What a unit of one kind of work costs.
struct WorkCost {
  std::string work;  ///< a name of kWorkClassNames
  double ns = 0.0;

  friend bool operator==(const WorkCost&, const WorkCost&) = default;
};
/// What ran the SUTs of a counted target and counted their work.
struct EmulatorInfo {
  std::string program;    ///< "qemu-x86_64"; empty: the SUTs' work was not counted
  std::string cpu_model;  ///< the emulated CPU
  std::vector<WorkCost> costs;

  friend bool operator==(const EmulatorInfo&, const EmulatorInfo&) = default;
};
/// The radio between the UAVs. A record of one UAV has none.
struct RadioInfo {
  std::string model;             ///< "ideal", "log_distance" or "distribution"; empty: none
  Duration least_delay{0};       ///< of a message without bytes
  double data_rate_bit_s = 0.0;  ///< 0: a message takes no time for its bytes
  /// How many messages an inbox holds. 0: this and what follows is unknown (Tether 0.1.0).
  std::uint64_t inbox_messages = 0;

  // Of "distribution": radio::Settings.
  Duration most_delay{0};  ///< of a message without bytes
  double loss_probability = 0.0;
  double burst_begin_probability = 0.0;
  double burst_end_probability = 0.0;

  // Of "log_distance": radio::Settings.
  std::string access{};  ///< "csma" or "tdma"
  std::uint64_t queue_messages = 0;
  std::uint64_t header_bytes = 0;
  Duration delay{0};  ///< from the call to the channel
  Duration preamble{0};
  Duration slot{0};
  double bandwidth_hz = 0.0;
  double tx_power_dbm = 0.0;
  double noise_figure_db = 0.0;
  double reference_loss_db = 0.0;
  double exponent = 0.0;
  double shadowing_db = 0.0;
  double wall_loss_db = 0.0;
  friend bool operator==(const RadioInfo&, const RadioInfo&) = default;
};
/// All settings, equal for equal ones; empty if there is no radio.
std::string to_text(const RadioInfo& radio);

/// Configuration of the run: written first (metadata record "tether"), as names and values.
struct Header {
  int schema_version = kSchemaVersion;
  std::string tether_version;
  std::string scenario;
  std::string condition;
  std::string policy;  ///< kConservativeBarrier or kFreeRunning
  std::string simulator;
  std::string machine;
  std::uint64_t seed = 0;
  Duration step{0};
  Duration ground_truth_period{0};  ///< between two messages of a UAV; 0: no fixed period
  double real_time_factor = 0.0;    ///< limit on ST per WT; 0: none
  Duration time_limit{0};           ///< at which the run ends; 0: unknown (Tether 0.1.0)
  std::vector<SutInfo> suts;
  std::vector<SensorInfo> sensors;
  std::vector<Anchor> anchors;
  std::vector<BoardInfo> boards{};     ///< that several SUTs share
  std::optional<TargetInfo> target{};  ///< none in records of Tether 0.1.0
  WallTime wall_at_start{};            ///< when the SUTs were started, all at ET 0; 0: unknown
  EmulatorInfo emulator{};
  bool reports_contacts = false;  ///< the record has all contacts; else it has none, and none is
                                  ///< known
  /// Nothing but the UAVs can move. False also in records of Tether 0.1.0.
  bool only_uavs_move = false;
  /// UAVs move by the forces of their rotors, gravity, drag and contacts alone. False: unknown.
  bool moves_by_forces = false;
  RadioInfo radio{};
};

}  // namespace tether::record
