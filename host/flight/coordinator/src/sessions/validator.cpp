#include "sessions/validator.h"

#include <algorithm>
#include <chrono>
#include <string_view>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include <tether/base/text.h>
#include <tether/sync/barrier_synchronizer.h>

namespace tether::coordinator {
namespace {

using Kind = Fault::Kind;
using MaybeFault = std::optional<Fault>;

// 146 years.
constexpr ExecTime kLatestStamp = from_ns<ExecTime>(std::int64_t{1} << 62);
/// Memory of an annotation besides its text.
constexpr std::size_t kAnnotationBytes = 128;

MaybeFault order_fault(const link::Request& request, const Standing& sut) {
  if (!sut.running) return Fault{Kind::kTooEarly, "a request before the Welcome"};
  if (sut.concurrent) {
    if (sut.open_calls >= sync::kMaxOpenCalls)
      return Fault{Kind::kTooMany,
                   fmt::format("a request while {} others are open", sut.open_calls)};
    if (sut.held)
      return Fault{Kind::kOutOfOrder,
                   fmt::format("a request at ET {} ns while it was stopped for a reply at {} ns",
                               to_ns(request.issued_at), to_ns(*sut.bound))};
  } else {
    if (sut.open_calls > 0)
      return Fault{Kind::kOutOfOrder, "a request while another request is open"};
    if (sut.finished) return Fault{Kind::kOutOfOrder, "a request after Finish"};
  }
  if (request.sequence == sut.next_sequence) return std::nullopt;
  return Fault{Kind::kOutOfOrder,
               fmt::format("request number {}, expected {}", request.sequence, sut.next_sequence)};
}

/// A timestamp ahead of the host clock would let the simulation run without synchronisation.
MaybeFault clock_fault(ExecTime stamp, const Standing& sut, WallTime now) {
  if (!sut.plausibility) return std::nullopt;
  const Duration excess = sut.plausibility->excess(stamp, now);
  if (excess == Duration(0)) return std::nullopt;
  return Fault{
      Kind::kAheadOfClock,
      fmt::format(
          "timestamp ET {:.6f} s, which is {:.6f} s ahead of the host clock (resumed at ET {:.6f} "
          "s{})",
          to_seconds(stamp), to_seconds(excess), to_seconds(sut.plausibility->went_on_at()),
          sut.clock_cores > 0
              ? fmt::format(
                    "; CPU time of {} cores; if several threads compute, let one do so at a time",
                    sut.clock_cores)
              : "")};
}

MaybeFault rate_fault(const Standing& sut) {
  if (sut.calls_in_step < kMaxCallsInAStep) return std::nullopt;
  return Fault{
      Kind::kTooMany,
      fmt::format("{} requests at ST {:.6f} s, more than the limit; a loop that waits must "
                  "sleep or advance its scripted clock",
                  kMaxCallsInAStep + 1, to_seconds(sut.st))};
}

MaybeFault body_fault(const link::ReadSensor& read, const Standing& sut) {
  if (read.sensor >= sut.sensors.size())
    return Fault{Kind::kNotAvailable,
                 fmt::format("a read of sensor {}, but the UAV has only {} sensors", read.sensor,
                             sut.sensors.size())};
  if (read.skips && !sut.sensors.is_periodic(read.sensor))
    return Fault{Kind::kNotAvailable,
                 fmt::format("a skip of sensor \"{}\", which measures on demand",
                             sut.sensors.name(read.sensor))};
  if (read.only_if_available && !sut.sensors.is_periodic(read.sensor))
    return Fault{Kind::kNotAvailable,
                 fmt::format("a read \"if available\" of sensor \"{}\", which measures on demand",
                             sut.sensors.name(read.sensor))};
  if (read.queue > 1 && !sut.sensors.is_periodic(read.sensor))
    return Fault{Kind::kNotAvailable,
                 fmt::format("a queue of sensor \"{}\", which measures on demand",
                             sut.sensors.name(read.sensor))};
  return std::nullopt;
}

MaybeFault room_fault(std::size_t setpoints, const Standing& sut) {
  if (sut.has_controller)
    return Fault{Kind::kNotAvailable,
                 fmt::format("a command, but its UAV has a flight controller, which takes commands "
                             "by MAVLink: send them to \"{}\"",
                             link::kAutopilot)};
  if (sut.waiting_setpoints + setpoints <= kMaxWaitingSetpoints) return std::nullopt;
  return Fault{Kind::kTooMany, fmt::format("a command while {} set-points are pending; at most {} "
                                           "may be",
                                           sut.waiting_setpoints, kMaxWaitingSetpoints)};
}

MaybeFault body_fault(const link::SetVelocity& set, const Standing& sut) {
  if (!complaint_about(to_setpoint(set.command)).empty())
    return Fault{Kind::kBadValue, "a velocity command that is not finite or too large"};
  return room_fault(1, sut);
}

MaybeFault body_fault(const link::SetTrajectory& set, const Standing& sut) {
  if (const std::string wrong = complaint_about(set.setpoints, sut.limits); !wrong.empty())
    return Fault{Kind::kBadValue, "a command that is invalid: " + wrong};
  return room_fault(set.setpoints.size(), sut);
}

MaybeFault body_fault(const link::Sleep& sleep, const Standing&) {
  if (!is_stamp(sleep.until)) return Fault{Kind::kStamp, "a sleep until a time out of range"};
  return std::nullopt;
}

MaybeFault body_fault(const link::Finish&, const Standing&) {
  return std::nullopt;
}

MaybeFault body_fault(const link::SendMessage& send, const Standing& sut) {
  const auto found = std::ranges::find(sut.uavs, send.to);
  if (send.to == link::kAutopilot && sut.has_controller) return std::nullopt;
  const bool is_known = send.to.empty()
                            ? sut.uavs.size() > 1
                            : found != sut.uavs.end() &&
                                  found != sut.uavs.begin() + static_cast<std::ptrdiff_t>(sut.uav);
  if (is_known) return std::nullopt;
  return Fault{Kind::kNotAvailable,
               fmt::format("a message to {}, which is no other UAV of the run",
                           send.to.empty() ? "all others" : "\"" + printable(send.to) + "\"")};
}

MaybeFault body_fault(const link::ReceiveMessage& receive, const Standing& sut) {
  for (const std::uint32_t sensor : receive.sensors)
    if (sensor >= sut.sensors.size() || !sut.sensors.is_periodic(sensor))
      return Fault{Kind::kNotAvailable,
                   fmt::format("a wait for sensor {}, which is no periodic one", sensor)};
  return std::nullopt;
}

MaybeFault body_fault(const link::ReadBattery&, const Standing& sut) {
  if (sut.has_battery) return std::nullopt;
  return Fault{Kind::kNotAvailable, "a read of the battery, but the UAV has none"};
}

MaybeFault stop_fault(ExecTime at, const Standing& sut) {
  if (!sut.concurrent)
    return Fault{Kind::kImpossibleStop, "a stop, which only concurrent SUTs may send"};
  if (at < sut.bound)
    return Fault{Kind::kImpossibleStop, fmt::format("a stop at ET {} ns after it had reached {} ns",
                                                    to_ns(at), to_ns(*sut.bound))};
  // The same stop again, for a message that has arrived meanwhile, is possible.
  if (sut.held && at > sut.bound)
    return Fault{Kind::kImpossibleStop,
                 fmt::format("a stop at ET {} ns while it was stopped for a reply at {} ns",
                             to_ns(at), to_ns(*sut.bound))};
  return std::nullopt;
}

}  // namespace

bool is_stamp(ExecTime t) {
  return t >= ExecTime{} && t < kLatestStamp;
}

MaybeFault fault_of(const link::Request& request, const Standing& sut, WallTime now) {
  if (auto fault = order_fault(request, sut)) return fault;
  if (!is_stamp(request.issued_at)) return Fault{Kind::kStamp, "a timestamp out of range"};
  if (auto fault = clock_fault(request.issued_at, sut, now)) return fault;
  if (auto fault = rate_fault(sut)) return fault;
  return std::visit([&](const auto& body) { return body_fault(body, sut); }, request.body);
}

MaybeFault fault_of(const link::Progress& progress, const Standing& sut, WallTime now) {
  if (auto fault = clock_fault(progress.reached, sut, now)) return fault;
  return progress.stopped ? stop_fault(progress.reached, sut) : std::nullopt;
}

Fault fault_of_other(const link::Message& message) {
  return {Kind::kWrongMessage, std::holds_alternative<link::Hello>(message)
                                   ? "a second Hello"
                                   : "a message that only the coordinator may send"};
}

MaybeFault AnnotationBudget::spend(const link::Annotation& note) {
  spent_bytes_ += kAnnotationBytes + note.topic.size() + note.json.size();
  if (spent_bytes_ <= kMaxAnnotatedBytes) return std::nullopt;
  return Fault{Kind::kTooMany,
               fmt::format("more than {} MiB of annotations", kMaxAnnotatedBytes >> 20)};
}

void SecondOfSending::add(SimTime at, std::size_t bytes) {
  const SimTime second = std::chrono::floor<std::chrono::seconds>(at);
  if (second != std::exchange(begin_, second)) messages_ = bytes_ = 0;
  ++messages_;
  bytes_ += bytes;
}

MaybeFault RadioBudget::spend(SimTime st, std::size_t bytes) {
  if (st != std::exchange(step_, st)) in_step_ = 0;
  second_.add(st, bytes);
  const auto flood = [](std::string_view limit, std::string_view where, SimTime at) {
    return Fault{Kind::kFlood,
                 fmt::format("more than {} {} ST {:.6g} s", limit, where, to_seconds(at))};
  };
  if (++in_step_ > kMaxMessagesInAStep)
    return flood(fmt::format("{} messages", kMaxMessagesInAStep), "at", st);
  if (second_.has_too_many())
    return flood(fmt::format("{} messages", kMaxMessagesInASecond), "in the second from",
                 second_.begin());
  if (second_.has_too_much())
    return flood(fmt::format("{} MiB", kMaxBytesInASecond >> 20), "in the second from",
                 second_.begin());
  return std::nullopt;
}

}  // namespace tether::coordinator
