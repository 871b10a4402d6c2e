#include "validator.h"

#include <variant>

#include <fmt/format.h>

#include <tether/sync/barrier_synchronizer.h>

namespace tether::coordinator {
namespace {

using Kind = Fault::Kind;
using MaybeFault = std::optional<Fault>;

// No honest stamp comes near (292 years are 2^63 ns).
constexpr ExecTime kLatestStamp = from_ns<ExecTime>(std::int64_t{1} << 62);
/// What an annotation takes up besides its text.
constexpr std::size_t kAnnotationBytes = 128;

MaybeFault order_fault(const link::Request& request, const Standing& sut) {
  if (!sut.running) return Fault{Kind::kTooEarly, "a request before the Welcome"};
  if (sut.concurrent) {
    if (sut.open_calls >= sync::kMaxOpenCalls)
      return Fault{Kind::kTooMany,
                   fmt::format("a request while {} others are open", sut.open_calls)};
    if (sut.tied && sut.held)
      return Fault{Kind::kOutOfOrder,
                   fmt::format("a request stamped {} ns while it was stopped for a reply at {} ns",
                               to_ns(request.issued_at), to_ns(sut.bound))};
  } else {
    if (sut.open_calls > 0) return Fault{Kind::kOutOfOrder, "a request while another one is held"};
    if (sut.finished) return Fault{Kind::kOutOfOrder, "a request after Finish"};
  }
  if (request.sequence == sut.next_sequence) return std::nullopt;
  return Fault{Kind::kOutOfOrder,
               fmt::format("request number {}, expected {}", request.sequence, sut.next_sequence)};
}

/// A stamp ahead of all that can have gone by would let the simulation run on unhindered.
MaybeFault clock_fault(ExecTime stamp, const Standing& sut, WallTime now) {
  if (!sut.witness) return std::nullopt;
  const Duration excess = sut.witness->excess(stamp, now);
  if (excess == Duration(0)) return std::nullopt;
  return Fault{
      Kind::kAheadOfClock,
      fmt::format(
          "a time stamp of ET {:.6f} s, which is {:.6f} s ahead: since it went on at ET "
          "{:.6f} s, no more can have gone by than this machine's clock shows{}",
          to_seconds(stamp), to_seconds(excess), to_seconds(sut.witness->went_on_at()),
          sut.clock_cores > 0 ? fmt::format(" for each of {} cores", sut.clock_cores) : "")};
}

MaybeFault standstill_fault(const Standing& sut) {
  if (!sut.tied || sut.calls_in_step < kMaxCallsInAStep) return std::nullopt;
  return Fault{Kind::kTooMany,
               fmt::format("{} requests while ST stood at {:.6f} s: a loop that waits must let "
                           "time go by, with a sleep or by its scripted clock",
                           kMaxCallsInAStep + 1, to_seconds(sut.st))};
}

MaybeFault body_fault(const link::ReadSensor& read, const Standing& sut) {
  if (read.sensor >= sut.sensors.size())
    return Fault{Kind::kNotAvailable, fmt::format("sensor number {}, but the UAV has {}",
                                                  read.sensor, sut.sensors.size())};
  if (read.only_if_available && !sut.sensors.is_periodic(read.sensor))
    return Fault{Kind::kNotAvailable,
                 fmt::format("a read of what sensor \"{}\" has, which measures on demand",
                             sut.sensors.name(read.sensor))};
  return std::nullopt;
}

MaybeFault body_fault(const link::SetVelocity& set, const Standing& sut) {
  if (!uav::is_valid(set.command))
    return Fault{Kind::kBadValue, "a velocity command that is not finite or beyond any multirotor"};
  if (sut.waiting_commands >= kMaxWaitingCommands)
    return Fault{Kind::kTooMany, fmt::format("a velocity command while {} others wait to act",
                                             kMaxWaitingCommands)};
  return std::nullopt;
}

MaybeFault body_fault(const link::Sleep& sleep, const Standing& sut) {
  if (!is_stamp(sleep.until))
    return Fault{Kind::kStamp, "a time to sleep until that is out of range"};
  if (!sut.tied)
    return Fault{Kind::kNotAvailable, "a sleep, which in free running is the SUT's own affair"};
  return std::nullopt;
}

MaybeFault body_fault(const link::Finish&, const Standing&) {
  return std::nullopt;
}

MaybeFault stop_fault(ExecTime at, const Standing& sut) {
  if (!sut.concurrent) return Fault{Kind::kImpossibleStop, "a stop, which is for concurrent SUTs"};
  if (at < sut.bound)
    return Fault{Kind::kImpossibleStop,
                 fmt::format("a stop at ET {} ns, although it had reached {} ns", to_ns(at),
                             to_ns(sut.bound))};
  if (sut.held)
    return Fault{Kind::kImpossibleStop,
                 fmt::format("a stop at ET {} ns while it was stopped for a reply at {} ns",
                             to_ns(at), to_ns(sut.bound))};
  return std::nullopt;
}

}  // namespace

bool is_stamp(ExecTime t) {
  return t >= ExecTime{} && t < kLatestStamp;
}

MaybeFault fault_of(const link::Request& request, const Standing& sut, WallTime now) {
  if (auto fault = order_fault(request, sut)) return fault;
  if (!is_stamp(request.issued_at)) return Fault{Kind::kStamp, "a time stamp out of range"};
  if (auto fault = clock_fault(request.issued_at, sut, now)) return fault;
  if (auto fault = standstill_fault(sut)) return fault;
  return std::visit([&](const auto& body) { return body_fault(body, sut); }, request.body);
}

MaybeFault fault_of(const link::Progress& progress, const Standing& sut, WallTime now) {
  if (auto fault = clock_fault(progress.reached, sut, now)) return fault;
  return progress.stopped ? stop_fault(progress.reached, sut) : std::nullopt;
}

Fault fault_of_other(const link::Message& message) {
  return {Kind::kWrongMessage, std::holds_alternative<link::Hello>(message)
                                   ? "a second Hello"
                                   : "a message that only coordinators send"};
}

MaybeFault AnnotationBudget::spend(const link::Annotation& note) {
  spent_bytes_ += kAnnotationBytes + note.topic.size() + note.json.size();
  if (spent_bytes_ <= kMaxAnnotatedBytes) return std::nullopt;
  return Fault{Kind::kTooMany,
               fmt::format("annotations of more than {} MiB", kMaxAnnotatedBytes >> 20)};
}

}  // namespace tether::coordinator
