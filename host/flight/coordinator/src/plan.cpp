#include "plan.h"

#include "header_facts.h"

#include <algorithm>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include <tether/base/text.h>
#include <tether/link/codec.h>

namespace tether::coordinator {
namespace {

// The reply to a read without a measurement is due at once.
ExecTime plan_read(std::size_t uav, record::Interaction& entry, const link::ReadSensor& read,
                   Stepper& stepper) {
  entry.sensor = stepper.sampler(uav).name(read.sensor);
  entry.latest = read.latest;
  entry.only_if_available = read.only_if_available || read.skips;
  if (read.skips) {
    entry.skipped_to = stepper.skip(uav, read, same_instant(entry.request_at));
    return entry.request_at;
  }
  const auto measurement = stepper.plan(uav, entry.sequence, read, same_instant(entry.request_at));
  if (!measurement) return entry.request_at;

  entry.sample_index = measurement->index;
  entry.sampled_at = measurement->sampled_at;
  entry.available_at = measurement->available_at;
  entry.sample_stamp = measurement->stamp;
  if (measurement->repeats > 0) entry.repeated_index = measurement->content();
  return std::max(entry.request_at, same_instant(measurement->available_at));
}

ExecTime plan_command(const Session& session, record::Interaction& entry,
                      std::vector<uav::TimedSetpoint> setpoints, Stepper& stepper) {
  const SimTime given = same_instant(entry.request_at);
  RandomKey key = session.latency_key;
  key.index = entry.sequence;
  const auto velocity = heading_velocity(setpoints.front().setpoint);
  if (velocity && setpoints.size() == 1) {
    const auto& [v, yaw_rate] = *velocity;
    entry.command = {v.x, v.y, v.z, yaw_rate};
  } else {
    for (const auto& [after, setpoint] : setpoints) {
      entry.setpoints.push_back(record_of(setpoint));
      entry.setpoints.back().after = after;
    }
  }
  const SimTime arrives = stepper.command({given + draw(session.command_latency, key), session.uav,
                                           entry.sequence, std::move(setpoints)});
  entry.effect_at = stepper.grid().ceil(arrives);
  entry.grid_error = *entry.effect_at - arrives;
  if (!std::holds_alternative<uav::ConstantDelay>(session.command_latency))
    entry.command_latency = arrives - given;
  return entry.request_at;
}

// A measurement that is available earlier is an earlier timeout.
ExecTime plan_receive(std::size_t uav, PendingInteraction& pending,
                      const link::ReceiveMessage& receive, const Stepper& stepper,
                      RadioTraffic& radio) {
  record::Interaction& entry = pending.entry;
  const ExecTime last = from_ns<ExecTime>(link::kMaxTimestampNs - 1);
  entry.receive_until =
      receive.timeout < last - entry.request_at ? entry.request_at + receive.timeout : last;
  for (const std::uint32_t sensor : receive.sensors) {
    const SimTime available =
        stepper.sampler(uav).next_available(sensor, same_instant(entry.request_at));
    entry.receive_until =
        std::min(*entry.receive_until, std::max(entry.request_at, same_instant(available)));
  }
  pending.received = radio.take_first(uav, same_instant(*entry.receive_until));
  return pending.received ? std::max(entry.request_at, same_instant(pending.received->at))
                          : *entry.receive_until;
}

}  // namespace

const char* kind_of(const link::Request& request) {
  constexpr const char* kKinds[] = {"sensor", "command", "sleep",   "finish",
                                    "send",   "receive", "battery", "command"};
  static_assert(std::size(kKinds) == std::variant_size_v<decltype(request.body)>);
  return kKinds[request.body.index()];
}

PendingInteraction arrive(const Session& session, Sent sent, Timeline& time) {
  const sync::Arrival arrival = time.arrive(sent);
  PendingInteraction pending;
  pending.request = std::get<link::Request>(std::move(sent.message));
  const link::Request& request = pending.request;
  record::Interaction& entry = pending.entry;
  entry.uav = session.uav_name;
  entry.sequence = request.sequence;
  entry.kind = kind_of(request);
  entry.request_at = arrival.charged_at;
  entry.lag = arrival.lag;
  if (arrival.violation)
    entry.violation =
        fmt::format("{} by {} ns", name(arrival.violation->kind), arrival.violation->size.count());
  entry.st_at_arrival = sent.st;
  entry.wall_at_arrival = sent.wall;
  entry.computed = sent.work;
  entry.stamped = time.facts().is_stamped;
  if (entry.stamped)
    for (const auto& [stage, computing] : request.stages)
      entry.stages.push_back({.stage = printable(stage),
                              .computing = computing,
                              .is_unknown = session.replay && !session.replay->knows(stage)});
  if (request.previous_round_trip > Duration(0) && time.last_hold() > Duration(0))
    entry.previous_link_time = request.previous_round_trip - time.last_hold();
  return pending;
}

ExecTime plan(Session& session, PendingInteraction& pending, const Parts& parts) {
  auto& [stepper, radio, controllers] = parts;
  const link::Request& request = pending.request;
  record::Interaction& entry = pending.entry;
  if (const auto* read = std::get_if<link::ReadSensor>(&request.body))
    return plan_read(session.uav, entry, *read, stepper);
  if (const auto* set = std::get_if<link::SetVelocity>(&request.body))
    return plan_command(session, entry, {{Duration(0), to_setpoint(set->command)}}, stepper);
  if (const auto* set = std::get_if<link::SetTrajectory>(&request.body))
    return plan_command(session, entry, set->setpoints, stepper);
  if (const auto* sleep = std::get_if<link::Sleep>(&request.body)) {
    entry.sleep_until =
        sleep->is_relative ? entry.request_at + (sleep->until - request.issued_at) : sleep->until;
    return std::max(entry.request_at, *entry.sleep_until);
  }
  if (const auto* send = std::get_if<link::SendMessage>(&request.body)) {
    const SimTime sent_at = same_instant(entry.request_at);
    if (send->to == link::kAutopilot)
      controllers.send(session.uav, request.sequence, sent_at, send->bytes);
    else
      radio.send(session.uav, request.sequence, sent_at, *send);
    return entry.request_at;
  }
  if (const auto* receive = std::get_if<link::ReceiveMessage>(&request.body))
    return plan_receive(session.uav, pending, *receive, stepper, radio);
  if (std::holds_alternative<link::ReadBattery>(request.body)) return entry.request_at;
  session.finish = std::get<link::Finish>(request.body);
  session.finish->outcome = printable(session.finish->outcome);
  return entry.request_at;
}

}  // namespace tether::coordinator
