#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <tether/base/time.h>
#include <tether/computer/clock.h>
#include <tether/uav/catalogue.h>
#include <tether/uav/samples.h>
#include <tether/uav/setpoint.h>

/// The messages between SUT and coordinator. The wire format (FlatBuffers, `schema/link.fbs`) has
/// the same fields; `codec.h` converts. Order: Hello → Welcome or Refusal; then Requests, each
/// answered by one Reply (or by Refusal, which ends the connection), with Progress and Annotation
/// one-way in between; Finish is the last Request. A SUT whose Hello says that it is concurrent may
/// have several open Requests; for each it receives at once the time at which its reply is due
/// (Due).
namespace tether::link {

inline constexpr std::uint32_t kProtocolVersion = 2;

/// The name of the client library's own thread, whose time is not the SUT's.
inline constexpr const char* kClientThread = "tether-client";

/// One of the things besides the program's own code that decide what it computes.
struct BuildPart {
  std::string name;   ///< "argument 4", "file detect.py", "library libopencv_core.so.406"
  std::string value;  ///< the argument; of files and libraries a digest or the build id
  friend bool operator==(const BuildPart&, const BuildPart&) = default;
};

/// SUT → coordinator, first.
struct Hello {
  std::uint32_t protocol_version = kProtocolVersion;
  std::string sut;          ///< the program's name and version
  std::string uav;          ///< which UAV it flies; empty: the only one
  computer::Clock clock{};  ///< of a scripted one that the sender does not know, `computing` is 0
  std::string token;
  /// Several threads or processes call, and each waits for its own reply only. Under the barrier
  /// all of them are stopped while a reply that is due has not arrived (Progress::stopped).
  bool concurrent = false;
  std::string build_id{};     ///< of the program, in hexadecimal digits; empty: it has none
  std::uint32_t process = 0;  ///< as the SUT's machine numbers it; 0: not known
  /// The program's arguments, the files that they name, and its libraries. Empty: not known.
  std::vector<BuildPart> build{};
};

/// What a SUT computed between two calls under one of its stages.
struct StageTime {
  std::string stage;
  Duration computing{0};
  friend bool operator==(const StageTime&, const StageTime&) = default;
};

/// The stage of what a SUT computes between two calls outside of its own stages. A call is named by
/// its sensor, or is "command", "sleep" or "finish"; before the first one is "start".
std::string stage_between(std::string_view previous_call, std::string_view call);

inline constexpr double kMaxRealTimeFactor = 1e4;
/// Coordinator → SUT: accepted.
struct Welcome {
  uav::Catalogue catalogue;
  bool free_running = false;  ///< policy: requests are answered at once, nothing is held
  ExecTime start;             ///< the SUT's ET begins here
  /// With the clock "replayed": what each stage takes until the first call.
  std::vector<StageTime> computing{};
  std::vector<std::string> peers{};  ///< to which messages can be sent: other UAVs, kAutopilot
  double real_time_factor = 1.0;     ///< in free running: ST per WT at most
};

/// Coordinator → SUT: not accepted, or the run is over. SUT → coordinator: its execution time is
/// not measured completely, which ends the run. The connection closes after it.
struct Refusal {
  enum class Reason : std::uint8_t { kVersion, kToken, kUav, kBadMessage, kBadRequest, kRunEnded };
  Reason reason = Reason::kBadMessage;
  std::string message;
};
std::string_view name(Refusal::Reason reason);

/// Most measurements that can wait in the queue of a sensor.
inline constexpr std::uint32_t kMaxQueue = 4096;

/// Read a sensor by its index in the catalogue.
struct ReadSensor {
  std::uint32_t sensor = 0;
  bool latest = false;  ///< periodic sensors: the newest measurement again, without waiting
  /// Periodic sensors: reply at once, without a sample if no suitable one is available.
  bool only_if_available = false;
  /// Periodic sensors: of so many of the newest measurements, the oldest that was not read. The
  /// queue fills from the first such read on.
  std::uint32_t queue = 1;
  /// Periodic sensors: reply at once, without a sample; what has arrived counts as read.
  bool skips = false;
};
/// Follow one set-point that is a velocity in the heading frame.
struct SetVelocity {
  uav::VelocityCommand command;
};
/// Follow any set-points: one at once, or a trajectory.
struct SetTrajectory {
  std::vector<uav::TimedSetpoint> setpoints;
};
/// Wait until ET `until`; in free running, until that ST.
struct Sleep {
  ExecTime until;
  /// The sleep ends as long after the request as `until` is after the request's stamp: on a board
  /// that several programs share, the request is later than its stamp.
  bool is_relative = false;
};
/// The SUT has finished. The reply confirms that this is in the record.
struct Finish {
  bool reached_goal = false;
  std::string outcome;  ///< one line: why
  std::string details;  ///< JSON object: results of the task; may be empty
};

/// The flight controller of a SUT's own UAV, as a sender and receiver of messages. No UAV of a run
/// with flight controllers has this name.
inline constexpr const char* kAutopilot = "autopilot";

/// Longest message by radio [bytes].
inline constexpr std::size_t kMaxRadioBytes = 64u << 10;
/// Send a message by radio, or to the flight controller. The reply is due at once, and does not
/// tell whether it will arrive.
struct SendMessage {
  std::string to;  ///< a UAV, or kAutopilot; empty: all other UAVs
  std::vector<std::uint8_t> bytes;
};
/// Most messages that one call receives.
inline constexpr std::uint32_t kMaxReceived = 64;
/// Wait for the next message, until `timeout` after the request at most.
struct ReceiveMessage {
  Duration timeout{0};  ///< 0: of those that have arrived
  /// And at most until one of these periodic sensors has a measurement that was not read. It is
  /// read by a request of its own.
  std::vector<std::uint32_t> sensors{};
  /// Of a serial SUT, if it is one of the flight controller: also those of it that come next and
  /// have arrived by the reply, at most so many in all.
  std::uint32_t most = 1;
};
/// Read the battery, if the catalogue has one. The reply is due at once.
struct ReadBattery {};

/// SUT → coordinator: an interaction begins.
struct Request {
  std::uint64_t sequence = 0;  ///< 1, 2, 3, …
  /// t_req; ignored from an unstamped client. Of a concurrent SUT, not before that of an earlier
  /// Request or Progress.
  ExecTime issued_at;
  Duration previous_round_trip{0};  ///< WT on the SUT's side from issuing the previous request to
                                    ///< having its reply; 0: not measured
  std::variant<ReadSensor, SetVelocity, Sleep, Finish, SendMessage, ReceiveMessage, ReadBattery,
               SetTrajectory>
      body;
  /// What was computed since the previous reply, each stage once, in the order of their beginning.
  /// Of a serial SUT that sends them, the sum is `issued_at` - the previous `resume_at`.
  std::vector<StageTime> stages{};
};

/// A message that has arrived. Its sender sent it at ET `sent_at`.
struct RadioMessage {
  std::string from;  ///< a UAV, or kAutopilot
  SimTime sent_at;
  SimTime arrived_at;
  std::vector<std::uint8_t> bytes;
};

/// Coordinator → SUT: the interaction ends.
struct Reply {
  std::uint64_t sequence = 0;
  ExecTime resume_at;                 ///< t_rep: the SUT goes on with ET = this
  std::optional<uav::Sample> sample;  ///< of ReadSensor; none if none was available
  /// With the clock "replayed": what each stage takes until the next call.
  std::vector<StageTime> computing{};
  std::optional<RadioMessage> message{};        ///< of ReceiveMessage; none: none arrived in time
  std::optional<uav::BatterySample> battery{};  ///< of ReadBattery
  std::vector<RadioMessage> more{};             ///< after `message`, in order
};

/// Coordinator → concurrent SUT under the barrier, as soon as a request has arrived: the time at
/// which its reply is due. The SUT may run until its ET reaches `reply_at`, and is stopped there
/// until the reply arrives. When a message arrives for an open ReceiveMessage, another Due follows,
/// with an earlier time.
struct Due {
  std::uint64_t sequence = 0;
  ExecTime reply_at;  ///< t_rep, ≥ the request's stamp
};

/// SUT → coordinator while it computes: ET has reached at least this. Or while it receives.
struct Progress {
  ExecTime reached{};
  /// Of a concurrent SUT under the barrier: all of its threads have been stopped since `reached`.
  bool stopped = false;
  /// Bytes of a frame that takes long to arrive, so far; the SUT is waiting for the rest, and
  /// `reached` has no meaning. 0: it is not.
  std::uint32_t received_bytes = 0;
  /// With `stopped`: how many Due messages had arrived. It has stopped for those, too.
  std::uint64_t dues_heard = 0;
};

/// SUT → coordinator: an entry for the record (ROI, estimate, task phase). Takes no ET and gets no
/// answer.
struct Annotation {
  ExecTime at;
  std::string topic;  ///< e.g. "task", "roi", "estimate"
  std::string json;   ///< one JSON object
};

using Message = std::variant<Hello, Welcome, Refusal, Request, Reply, Progress, Annotation, Due>;

}  // namespace tether::link
