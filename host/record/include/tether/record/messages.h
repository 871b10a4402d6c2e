#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <tether/base/time.h>
#include <tether/computer/clock.h>
#include <tether/record/commands.h>

/// The contents of a run's record (DESIGN section 5): plain data, one struct per kind of message.
/// All times in a record are integer nanoseconds; a message's log time is the ST at which it was
/// written. Texts are UTF-8 (other bytes are written as U+FFFD). A number that is not finite is
/// written as null and read as NaN.
namespace tether::record {

inline constexpr int kSchemaVersion = 1;

/// Values of Header::policy.
inline constexpr std::string_view kConservativeBarrier = "conservative_barrier";
inline constexpr std::string_view kFreeRunning = "free_running";

/// Values of Interaction::kind.
inline constexpr std::string_view kSensor = "sensor";
inline constexpr std::string_view kCommand = "command";
inline constexpr std::string_view kSleep = "sleep";
inline constexpr std::string_view kFinish = "finish";
inline constexpr std::string_view kSend = "send";
inline constexpr std::string_view kReceive = "receive";
inline constexpr std::string_view kBattery = "battery";

/// Values of RadioMessage::outcome; others say why the message was lost.
inline constexpr std::string_view kDelivered = "delivered";
inline constexpr std::string_view kWaiting = "waiting";  ///< at the end of the run

/// Where an anchor is seen in an image: the first and last column and row of its visible pixels.
struct SeenAnchor {
  std::string anchor;
  int left_px = 0, top_px = 0, right_px = 0, bottom_px = 0;
  std::uint64_t pixels = 0;  ///< how many are visible, > 0
  friend bool operator==(const SeenAnchor&, const SeenAnchor&) = default;
};

/// What a SUT computed between two calls under one of its stages.
struct StageTime {
  std::string stage;
  Duration computing{0};
  bool is_unknown = false;  ///< clock "replayed": the timing file does not have this stage
  friend bool operator==(const StageTime&, const StageTime&) = default;
};

/// What a call of kind "receive" returned.
struct ReceivedMessage {
  std::string from;            ///< the sender's UAV
  std::uint64_t sequence = 0;  ///< of the sender's call of kind "send"
  SimTime arrived_at;
  friend bool operator==(const ReceivedMessage&, const ReceivedMessage&) = default;
};

/// What a call of kind "battery" returned.
struct BatteryReading {
  double voltage_V = 0.0;
  double current_A = 0.0;
  double charge = 0.0;  ///< share of the capacity
  friend bool operator==(const BatteryReading&, const BatteryReading&) = default;
};

/// One request of a SUT and its reply. Topic /interactions; log time = ST at release.
struct Interaction {
  std::string uav;
  /// 1, 2, 3, … for each SUT. The record has the interactions of a concurrent SUT in the order of
  /// their replies, without calls that were still open when the SUT finished.
  std::uint64_t sequence = 0;
  std::string kind;     ///< kSensor, kCommand, kSleep, kFinish, kSend, kReceive or kBattery
  ExecTime request_at;  ///< t_req
  ExecTime reply_at;    ///< t_rep

  // For kind "sensor". A read that returned nothing has no times and no index.
  std::string sensor;
  std::uint64_t sample_index = 0;
  bool latest = false;                ///< asked for the newest measurement, even if read before
  bool only_if_available = false;     ///< asked for an available measurement, without waiting
  std::optional<SimTime> sampled_at;  ///< time of the sample by the timing model
  std::optional<SimTime> sample_state_at;  ///< step boundary whose state was measured (its floor)
  std::optional<SimTime> available_at;     ///< sampled_at + delay

  /// Of an image: the anchors that are seen in it; those that are hidden or outside are missing.
  /// None if the simulator does not know this, and in records of Tether 0.1.0: then an anchor's
  /// true region is the projection of its shape, whatever is in front of it.
  std::optional<std::vector<SeenAnchor>> seen_anchors{};

  std::optional<SimTime> effect_at;  ///< kind "command": first step boundary it acts on
  /// Kind "command": what the SUT asked for; none in records of Tether 0.1.0. Either one velocity
  /// in the heading frame, or set-points.
  std::optional<VelocityCommand> command{};
  std::vector<Setpoint> setpoints{};
  /// From request_at until the command arrived, before rounding; none if it is constant.
  std::optional<Duration> command_latency{};
  std::optional<ExecTime> sleep_until;  ///< kind "sleep": requested end of the sleep

  // For kind "receive".
  std::optional<ExecTime> receive_until{};    ///< request_at + timeout
  std::optional<ReceivedMessage> received{};  ///< none: no message had arrived by then

  std::optional<BatteryReading> battery{};  ///< kind "battery": at st_at_release

  SimTime st_at_arrival;
  SimTime st_at_release;
  Duration lag{0};  ///< ε = request_at − st_at_arrival
  /// The largest of the distances by which the step grid moved the sample (sampled_at −
  /// sample_state_at), the effect (effect_at − (request_at + command latency)) and the release
  /// (reply_at − st_at_release). From 0 to less than one step.
  Duration grid_error{0};
  bool stamped = true;                   ///< request_at is a timestamp of the SUT
  std::optional<std::string> violation;  ///< description of a causality violation
  /// What the SUT computed since its previous call, in the order of beginning. Their sum is the
  /// growth of ET since the previous reply; of a concurrent SUT, that of the calling thread. Empty:
  /// not measured (free running, a client without stages).
  std::vector<StageTime> stages{};
  /// On a board that several SUTs share: what the SUT computed since its previous call. ET grew by
  /// this, and by the time for which others had its share of the cores; the stages are this only.
  std::optional<Duration> computed{};

  // Host clock; differs between runs. 0: not measured.
  WallTime wall_at_arrival;  ///< when the coordinator received the request
  WallTime wall_at_release;  ///< just before the reply was sent
  /// Round trip of the previous interaction, minus the time for which it was held.
  std::optional<Duration> previous_link_time;
};

/// All threads of a concurrent SUT were stopped by the barrier. Topic /stops/<uav>; log time = ST
/// when the stop was reported.
struct Stop {
  std::string uav;
  ExecTime at;  ///< ET of the stop, with which the SUT also resumes
  /// t_rep of the earliest reply that was due by `at` and had not been sent; none if the stop was
  /// for requests whose replies are due later.
  std::optional<ExecTime> reply_at;
  WallTime wall;  ///< host clock when the stop was reported; 0: not measured
};

/// A set-point takes effect: written when it is passed to the simulator. Topic /commands/<uav>; log
/// time = ST. Velocity in the heading frame H, or `setpoint`.
struct CommandEffect {
  std::string uav;
  std::uint64_t sequence = 0;  ///< of the command; of a loss, of the last one
  SimTime applied_at;
  double vx_H_m_s = 0, vy_H_m_s = 0, vz_H_m_s = 0, yaw_rate_rad_s = 0;

  std::optional<Setpoint> setpoint{};  ///< none: the velocity above
  std::uint64_t index = 0;             ///< of the set-point in its command
  std::string loss{};                  ///< the link was lost, and this is done; empty: it was not

  VelocityCommand command() const { return {vx_H_m_s, vy_H_m_s, vz_H_m_s, yaw_rate_rad_s}; }
};

/// State of the UAV's body B in the world frame W. Topic /ground_truth/<uav>; log time = `at`. The
/// pose is also written as foxglove.FrameTransform on /tf, so that a 3D view shows it.
struct GroundTruth {
  std::string uav;
  SimTime at;
  double p_WB_m[3] = {};
  double q_WB[4] = {1, 0, 0, 0};  ///< w x y z
  double v_WB_m_s[3] = {};
  double w_WB_B_rad_s[3] = {};
  /// Distance to the nearest surface of anything else; none: not measured, or a record of Tether
  /// 0.1.0.
  std::optional<double> clearance_m{};
};

/// A UAV began to touch something. Topic /contacts/<uav>; log time = ST of the next ground truth,
/// or of the end of the run.
struct Contact {
  std::string uav;
  SimTime at;              ///< step boundary at which both touched for the first time
  std::string with;        ///< name of the model or UAV
  double speed_m_s = 0.0;  ///< of approach along the contact's normal, just before the impact; ≥ 0
  friend bool operator==(const Contact&, const Contact&) = default;
};

/// The battery of a UAV, and the energy that was spent since ST 0, by cause (energy::Cause). Only
/// if the scenario gives the UAV a model of energy. Topic /battery/<uav>; log time = `at`, that of
/// each ground truth.
struct Battery {
  std::string uav;
  SimTime at;
  double voltage_V = 0.0;  ///< at the terminals
  double current_A = 0.0;
  double charge = 0.0;  ///< share of the capacity
  double lift_J = 0.0, moving_J = 0.0, idle_J = 0.0, computing_J = 0.0, sensors_J = 0.0,
         resistance_J = 0.0;

  double spent_j() const {
    return lift_J + moving_J + idle_J + computing_J + sensors_J + resistance_J;
  }
  friend bool operator==(const Battery&, const Battery&) = default;
};

/// What became of a message between two UAVs: written when it arrived or was lost, and at the end
/// of the run if neither is known. A message to all UAVs has one for each of them. Topic /radio;
/// log time = ST at `at`.
struct RadioMessage {
  std::string uav;             ///< the sender's
  std::uint64_t sequence = 0;  ///< of its call of kind "send"
  std::string to;              ///< the receiver's UAV
  std::uint64_t bytes = 0;
  SimTime sent_at;  ///< ET of the call
  SimTime at;       ///< when it arrived, was lost, or the run ended
  /// "delivered"; lost: "noise", "collision", "half_duplex", "queue_full", "too_long",
  /// "inbox_full"; "waiting" at the end of the run.
  std::string outcome;
  std::optional<SimTime> began_at{};     ///< of the transmission
  std::optional<double> distance_m{};    ///< between the UAVs; none: ideal, or not transmitted
  std::optional<std::uint64_t> walls{};  ///< between them
  std::optional<double> snr_db{};        ///< signal to noise and interference
  friend bool operator==(const RadioMessage&, const RadioMessage&) = default;
};

/// A message of the SUT for the record. Topic /task/<uav>; log time = ST when it arrived.
struct Annotation {
  std::string uav;
  ExecTime at;
  std::string topic;
  std::string json;  ///< one JSON object; other text is stored as {"text": …}
};

/// Topic /images/<uav>/<sensor>: foxglove.CompressedImage (PNG).
struct Image {
  std::string uav;
  std::string sensor;
  SimTime at;
  std::uint64_t index = 0;
  std::vector<std::uint8_t> png;  ///< a PNG file
};

/// Topic /depth/<uav>/<sensor> or /labels/<uav>/<sensor>: foxglove.RawImage (32FC1 or 16UC1), rows
/// from the top down without gaps. The header's CameraInfo::models has the meaning of labels.
struct RawImage {
  std::string uav;
  std::string sensor;
  SimTime at;
  std::uint64_t index = 0;
  int width_px = 0;  ///< 1 to 100 000, as the height
  int height_px = 0;
  /// Depths along the optical axis [m], as in uav::CameraSample, or labels.
  std::variant<std::vector<float>, std::vector<std::uint16_t>> pixels;
};

/// What a run logs between its header and its end.
using Message = std::variant<Interaction, CommandEffect, GroundTruth, Annotation, Stop, Contact,
                             Battery, RadioMessage, Image, RawImage>;

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
};
/// Where it is at that instant, as an anchor without a path.
Anchor anchor_at(const Anchor& anchor, SimTime at);
/// Mounting and intrinsics of a camera, for projections into its images.
struct CameraInfo {
  double p_BS_m[3] = {};  ///< mounting in the UAV's body B; S is body-style (x forward)
  double q_BS[4] = {1, 0, 0, 0};
  int width_px = 0;  ///< 1 to 100 000, as the height
  int height_px = 0;
  double fx_px = 0, fy_px = 0;  ///< focal lengths, > 0
  double cx_px = 0, cy_px = 0;  ///< principal point, from the centre of the upper left pixel
  double k1 = 0, k2 = 0, k3 = 0, p1 = 0, p2 = 0;  ///< Brown-Conrady distortion, as in SDF
  double depth_min_m = 0, depth_max_m = 0;        ///< 0: measures no depths
  std::vector<std::string> models{};  ///< of a segmentation camera: those that labels 1, 2, … show
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
struct SutInfo {
  std::string uav;
  std::string sut;  ///< name and version that the SUT reported
  computer::Clock clock{};
  /// From a command's timestamp to its effect, before rounding; the least if it is drawn.
  Duration command_latency{0};
  bool concurrent = false;  ///< several threads with parallel calls
  /// Clock "cpu": number of cores whose CPU time can add up; 0: unknown.
  int cores = 0;
  /// The most that rotors and gravity together can accelerate the UAV; 0: unknown, as in records of
  /// Tether 0.1.0.
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
/// Readings of a machine by name, see host/board/src/target_probe.sh: "governor",
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
  std::string model;             ///< "ideal" or "log_distance"; empty: none
  Duration least_delay{0};       ///< of a message without bytes
  double data_rate_bit_s = 0.0;  ///< 0: a message takes no time for its bytes
  /// How many messages an inbox holds. 0: this and what follows is unknown (Tether 0.1.0).
  std::uint64_t inbox_messages = 0;

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

/// How close a UAV came to anything else: to the nearest collision shape, at the instants of the
/// ground truth.
struct Clearance {
  std::string uav;
  double min_m = 0.0;  ///< 0: it touched, or was inside
  SimTime at;          ///< when that was for the first time
  std::string to;      ///< name of the model or UAV
  friend bool operator==(const Clearance&, const Clearance&) = default;
};

/// How many messages of a topic the record has.
struct TopicCount {
  std::string topic;
  std::uint64_t messages = 0;
  friend bool operator==(const TopicCount&, const TopicCount&) = default;
};

/// End of the run: written last (metadata record "tether.end"). A record without it is incomplete.
struct Footer {
  /// "finished", "time_limit", "sut_lost", "sut_hung", "simulator_lost", "interrupted",
  /// "battery_empty", "timing_differs", "flooded".
  std::string end;
  std::string reason;  ///< one line
  SimTime st_at_end;
  std::vector<ExecTime> et_at_end;  ///< per SUT, in the header's order
  Duration wall{0};
  std::uint64_t interactions = 0;  ///< number in the record
  std::uint64_t causality_violations = 0;
  Duration largest_lag{0};  ///< 0 when none was positive
  Duration largest_grid_error{0};
  Readings target_after{};  ///< of the machine that the SUTs ran on, after the run
  // For concurrent SUTs.
  std::uint64_t stops = 0;        ///< number in the record
  Duration largest_overshoot{0};  ///< largest Stop::at − Stop::reply_at
  /// Of the UAVs whose clearance was measured.
  std::vector<Clearance> clearances{};
  std::vector<std::string> expelled{};  ///< UAVs whose SUTs lost their sessions in the run
  /// Of each topic with messages, filled in by the recorder. Empty in records of Tether 0.1.0.
  std::vector<TopicCount> topics{};
};

}  // namespace tether::record
