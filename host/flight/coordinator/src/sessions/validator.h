#pragma once

#include "sensors/sampler.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include <tether/link/messages.h>
#include <tether/sync/clock_plausibility.h>

/// Checks messages of a SUT against the protocol and its earlier messages. Pure: times are
/// arguments.
namespace tether::coordinator {

/// Limit on the calls of a SUT between two steps of ST. Without it, a loop of calls that take
/// almost no time would never end.
inline constexpr std::size_t kMaxCallsInAStep = 10'000;
/// Limit per UAV: a latency of one second with a command every 15 us.
inline constexpr std::size_t kMaxWaitingSetpoints = 65'536;
/// Limits on the messages by radio of a SUT: between two steps of ST, in a second of ST (to each of
/// 250 UAVs 40 times a second), their bytes in a second (0.5 Gbit/s), and those for which its queue
/// has no room (`RadioTraffic::flood_of`). They bound the record and what an ideal radio has in
/// transit. A SUT that exceeds them loses its session; the others finish. What exceeds those of a
/// second on the line of a flight controller is lost (`Line`).
inline constexpr std::size_t kMaxMessagesInAStep = 1'000;
inline constexpr std::size_t kMaxMessagesInASecond = 10'000;
inline constexpr std::size_t kMaxBytesInASecond = std::size_t{64} << 20;
inline constexpr std::size_t kMaxFullQueues = 1'000;
/// Limit on the annotations of a SUT in a run: two hours of 1 kB for each of 30 images a second.
inline constexpr std::size_t kMaxAnnotatedBytes = std::size_t{256} << 20;

/// A protocol violation by a SUT.
struct Fault {
  enum class Kind {
    kWrongMessage,   ///< a message that a SUT must not send, or only once
    kTooEarly,       ///< a request before the Welcome
    kOutOfOrder,     ///< a request while it is held, after its Finish, or with a wrong number
    kTooMany,        ///< open calls, calls in a step, commands or annotations
    kStamp,          ///< a time that is out of range
    kAheadOfClock,   ///< a stamp later than the host clock allows
    kNotAvailable,   ///< the UAV has no such sensor, or the run no such call
    kBadValue,       ///< a command that is not finite, too large, or makes no sense
    kFlood,          ///< too many messages by radio
    kImpossibleStop  ///< a stop of a serial SUT, in the past, or while held
  };
  Kind kind;
  std::string what;  ///< for people: continues "the SUT of UAV … sent"
};

/// The state of a SUT that decides which messages it may send next.
struct Standing {
  bool running = false;     ///< every SUT has joined
  bool concurrent = false;  ///< it has several threads
  bool finished = false;    ///< its Finish has arrived
  bool held = false;        ///< it is stopped until a reply
  /// ET that it has reached; the reply's if it is held. None before the Welcome and in free
  /// running.
  std::optional<ExecTime> bound{};
  std::size_t open_calls = 0;
  std::uint32_t received_bytes = 0;  ///< of a reply that takes long to arrive
  std::uint64_t next_sequence = 1;
  SimTime st;
  std::size_t calls_in_step = 0;        ///< at this ST
  std::size_t waiting_setpoints = 0;    ///< of commands that are not in effect yet
  std::span<const std::string> uavs{};  ///< all of the run; its own is `uav`
  std::size_t uav = 0;
  const Sampler& sensors;
  bool has_battery = false;
  uav::FlightLimits limits{};
  bool has_controller = false;  ///< a flight controller, which takes its commands
  const sync::ClockPlausibility* plausibility = nullptr;  ///< nullptr: its clock is not checked
  int clock_cores = 0;  ///< cores whose time its CPU clock adds up; 0: another clock
};

/// Whether a time is in the range of timestamps. Sums of these and delays do not overflow int64.
bool is_stamp(ExecTime t);
/// What is wrong with a request received at `now`; none if nothing is.
std::optional<Fault> fault_of(const link::Request& request, const Standing& sut, WallTime now);
/// The same for progress and stops. @pre is_stamp(progress.reached).
std::optional<Fault> fault_of(const link::Progress& progress, const Standing& sut, WallTime now);
/// The fault of a message that is neither Request, Progress nor Annotation.
Fault fault_of_other(const link::Message& message);

/// Limits the annotations of one SUT, because a record is read into memory for evaluation.
class AnnotationBudget {
 public:
  std::optional<Fault> spend(const link::Annotation& note);

 private:
  std::size_t spent_bytes_ = 0;
};

/// What one sender sends in each second of ST.
class SecondOfSending {
 public:
  /// @pre not before the last one
  void add(SimTime at, std::size_t bytes);
  SimTime begin() const { return begin_; }
  bool has_too_many() const { return messages_ > kMaxMessagesInASecond; }
  bool has_too_much() const { return bytes_ > kMaxBytesInASecond; }

 private:
  SimTime begin_{};
  std::size_t messages_ = 0, bytes_ = 0;
};

/// Limits the messages by radio of one SUT.
class RadioBudget {
 public:
  /// A message is sent at `st`. @pre not before the last one
  std::optional<Fault> spend(SimTime st, std::size_t bytes);

 private:
  SimTime step_{};
  std::size_t in_step_ = 0;
  SecondOfSending second_;
};

}  // namespace tether::coordinator
