#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <tether/base/time.h>
#include <tether/record/header.h>
#include <tether/uav/setpoint.h>

/// What was commanded, as messages of a record have it.
namespace tether::record {

/// A velocity in the heading frame H, and a yaw rate.
struct VelocityCommand {
  double vx_H_m_s = 0, vy_H_m_s = 0, vz_H_m_s = 0, yaw_rate_rad_s = 0;
  friend bool operator==(const VelocityCommand&, const VelocityCommand&) = default;
};

/// Any other set-point: what its mask has (tether/uav/setpoint.h).
struct Setpoint {
  Duration after{0};  ///< of the set-points of a command: from when it arrives
  std::uint64_t mask = 0;
  bool in_heading = false;  ///< velocity and acceleration are in H, else in W
  double p_WB_m[3] = {};
  double velocity_m_s[3] = {};
  double acceleration_m_s2[3] = {};
  double yaw_rad = 0.0;
  double yaw_rate_rad_s = 0.0;
  double q_WB[4] = {1, 0, 0, 0};  ///< w x y z
  double w_WB_B_rad_s[3] = {};
  double thrust_N = 0.0;
  std::vector<double> rotor_speeds_rad_s{};
  std::vector<double> joints_rad{};
  friend bool operator==(const Setpoint&, const Setpoint&) = default;
};

// The contents of a run's record (DESIGN section 5): plain data, one struct per kind of message.
// All times in a record are integer nanoseconds; a message's log time is the ST at which it was
// written. Texts are UTF-8 (other bytes are written as U+FFFD). A number that is not finite is
// written as null and read as NaN.

/// Values of Interaction::kind.
inline constexpr std::string_view kSensor = "sensor";
inline constexpr std::string_view kCommand = "command";
inline constexpr std::string_view kSleep = "sleep";
inline constexpr std::string_view kFinish = "finish";
inline constexpr std::string_view kSend = "send";
inline constexpr std::string_view kReceive = "receive";
inline constexpr std::string_view kBattery = "battery";

/// Values of the outcome of a message; others say why the message was lost.
inline constexpr std::string_view kDelivered = "delivered";
inline constexpr std::string_view kWaiting = "waiting";  ///< at the end of the run
inline constexpr std::string_view kQueueFull = "queue_full";
inline constexpr std::string_view kInboxFull = "inbox_full";
inline constexpr std::string_view kIgnored = "ignored";  ///< see AutopilotMessage::outcome

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
  /// What the SUT saw as the time of the sample; none: sample_state_at. Only if the sensor has a
  /// model of its driver.
  std::optional<SimTime> sample_stamp{};
  /// The driver delivered the content of this earlier measurement again. `sampled_at` and
  /// `sample_state_at` are that measurement's, `available_at` is that of `sample_index`.
  std::optional<std::uint64_t> repeated_index{};

  /// Asked for no measurement, but to count those that were available as read, up to this one.
  std::optional<std::uint64_t> skipped_to{};

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
  std::optional<ExecTime> receive_until{};    ///< request_at + timeout, or when a sensor is ready
  std::optional<ReceivedMessage> received{};  ///< none: no message had arrived by then
  std::uint64_t received_more = 0;            ///< of the flight controller, the next ones in order

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
  std::vector<double> joints_rad{};  ///< angles of SutInfo::joints
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
  /// "inbox_full", "dropped"; "waiting" at the end of the run.
  std::string outcome;
  std::optional<SimTime> began_at{};     ///< of the transmission
  std::optional<double> distance_m{};    ///< between the UAVs; none: no channel, or not transmitted
  std::optional<std::uint64_t> walls{};  ///< between them
  std::optional<double> snr_db{};        ///< signal to noise and interference
  friend bool operator==(const RadioMessage&, const RadioMessage&) = default;
};

/// A message between a UAV's flight controller and its SUT: written when the controller has taken
/// it, when it has arrived at the SUT, when it was lost, and at the end of the run if neither is
/// known. Topic /autopilot/<uav>/<"to", "from" or "station">/<name>; log time = ST then.
struct AutopilotMessage {
  std::string uav;
  bool to_controller = false;
  std::uint64_t sequence =
      0;                    ///< of the SUT's call of kind "send"; of the controller's: 1, 2, 3, …
  std::uint64_t part = 0;   ///< of several messages that were sent as one: 0, 1, 2, …
  std::uint64_t bytes = 0;  ///< of all that was sent as one
  SimTime sent_at;          ///< ET of the call; a step of the controller + 1 ns
  SimTime at;               ///< when it arrived or was lost
  std::optional<SimTime> acted_at{};  ///< the step of the controller that has taken it
  /// "delivered", "queue_full", "inbox_full" or "waiting"; of a signed link, also "not_signed",
  /// "wrong_signature" and "old_signature": the controller refused it. "ignored": a
  /// set-point that the built-in controller cannot fly, or that is for another system.
  std::string outcome;
  std::string name;    ///< of the MAVLink message; empty: the bytes are no message that is known
  std::string fields;  ///< its values: a JSON object, which is written as it is; empty: none

  /// Of a ground station, not of the SUT; `to_controller` is false.
  bool of_station = false;

  std::string_view direction() const {
    return of_station ? "station" : to_controller ? "to" : "from";
  }
  /// By the controller, which did not act on it.
  bool is_refused() const { return outcome == kIgnored || is_unsigned(); }
  /// … whose link is signed.
  bool is_unsigned() const {
    return outcome == "not_signed" || outcome == "wrong_signature" || outcome == "old_signature";
  }
  bool of_controller() const { return !to_controller && !of_station; }
  /// Whether the controller says what it refuses, or in which state it is.
  bool tells_state() const {
    return of_controller() && (name == "STATUSTEXT" || name == "COMMAND_ACK" ||
                               name == "MISSION_ACK" || name == "HEARTBEAT");
  }
  /// Whether it is a command of what to fly now.
  bool is_setpoint() const {
    return to_controller && outcome != kIgnored && uav::is_setpoint(name);
  }
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
                             Battery, RadioMessage, AutopilotMessage, Image, RawImage>;

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
  /// "battery_empty", "timing_differs", "flooded", "killed".
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
  /// UAVs whose SUTs computed when the run ended, from their last reply to their ET at the end.
  /// Without concurrent SUTs and those on modelled boards that others share.
  std::vector<std::string> computing{};
};

}  // namespace tether::record
