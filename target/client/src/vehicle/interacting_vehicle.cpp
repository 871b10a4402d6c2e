#include "vehicle/interacting_vehicle.h"

#include <algorithm>
#include <string>
#include <utility>
#include <variant>

#include <tether/base/text.h>
#include <tether/link/codec.h>

// What serial and concurrent vehicles have in common: making requests, checking arguments against
// the catalogue, and checking replies against the rules of time (docs/design.md section 2).
namespace tether::client {
namespace {

/// Of a camera: whether the image has the size and the arrays that the catalogue promised.
Status check_image(const uav::Sample& sample, const uav::SensorDescription& sensor) {
  const auto* image = std::get_if<uav::CameraSample>(&sample);
  const auto* camera = std::get_if<uav::CameraProperties>(&sensor.properties);
  if (image == nullptr || camera == nullptr) return ok_status();
  const auto failure = [&sensor](const std::string& what) {
    return protocol_failure("its image has other " + what + " than the catalogue gives for '" +
                            sensor.name + "'");
  };
  if (image->width_px != camera->model.width_px || image->height_px != camera->model.height_px)
    return failure("sizes");
  const bool is_complete =
      image->rgb.empty() != uav::has_color(camera->kind) &&
      image->depth_m.empty() != uav::has_depth(camera->kind) &&
      image->labels.empty() == (camera->kind != uav::CameraKind::kSegmentation);
  return is_complete ? ok_status() : failure("contents");
}

}  // namespace

Failure to_failure(const link::Refusal& refusal) {
  const bool ended = refusal.reason == link::Refusal::Reason::kRunEnded;
  const std::string why = printable(refusal.message);
  return {ended ? Failure::Kind::kRunEnded : Failure::Kind::kRefused,
          why.empty() ? "the coordinator refused the connection without giving a reason" : why};
}

Failure protocol_failure(const std::string& what) {
  return {Failure::Kind::kProtocol, "protocol violation in the coordinator's reply: " + what};
}

// As much as makes an unseen wait doubtful: that long, and one part in a hundred of its time.
constexpr Duration kLeastUncharged = std::chrono::milliseconds(100);
constexpr std::int64_t kLeastPartUncharged = 100;
/// From this part on, what the program is charged may be what others computed while it waited.
constexpr std::int64_t kLeastPartOfOthers = 5;

Failure mission_finished() {
  return {Failure::Kind::kInvalid, "the mission is finished; no more calls are possible"};
}

Status check(const link::Reply& reply, const link::Request& request,
             const uav::Catalogue& catalogue, bool free_running) {
  if (reply.sequence != request.sequence) {
    return protocol_failure("it answers request " + std::to_string(reply.sequence) + ", not " +
                            std::to_string(request.sequence));
  }
  if (free_running) return ok_status();
  if (reply.resume_at < request.issued_at)
    return protocol_failure("its time is before the request");
  const auto* read = std::get_if<link::ReadSensor>(&request.body);
  const bool has_own_stamp = read && catalogue.sensors[read->sensor].own_stamps;
  if (reply.sample && !has_own_stamp &&
      uav::sampled_at(*reply.sample) > same_instant(reply.resume_at)) {
    return protocol_failure("its sample is from the future");
  }
  const auto is_later = [&](const link::RadioMessage& message) {
    return message.arrived_at > same_instant(reply.resume_at);
  };
  if ((reply.message && is_later(*reply.message)) || std::ranges::any_of(reply.more, is_later)) {
    return protocol_failure("its message is from the future");
  }
  if (reply.battery && reply.battery->sampled_at > same_instant(reply.resume_at)) {
    return protocol_failure("its battery is from the future");
  }
  return ok_status();
}

ExecTime add_within_bounds(ExecTime et, Duration duration) {
  const ExecTime last = from_ns<ExecTime>(link::kMaxTimestampNs - 1);
  if (duration <= Duration::zero()) return et;
  return duration >= last - et ? last : et + duration;
}

link::Sleep make_sleep(ExecTime until) {
  const ExecTime last = from_ns<ExecTime>(link::kMaxTimestampNs - 1);
  return {std::clamp(until, ExecTime{}, last)};
}

std::string name_of_call(const decltype(link::Request::body)& body,
                         const uav::Catalogue& catalogue) {
  if (const auto* read = std::get_if<link::ReadSensor>(&body))
    return catalogue.sensors[read->sensor].name;
  if (std::holds_alternative<link::SetVelocity>(body) ||
      std::holds_alternative<link::SetTrajectory>(body))
    return "command";
  if (std::holds_alternative<link::Sleep>(body)) return "sleep";
  if (std::holds_alternative<link::SendMessage>(body)) return "send";
  if (std::holds_alternative<link::ReadBattery>(body)) return "battery";
  return std::holds_alternative<link::ReceiveMessage>(body) ? "receive" : "finish";
}

Failure InteractingVehicle::give_up(Failure failure) {
  const std::lock_guard lock(mutex_);
  if (!over_) over_ = failure;
  return failure;
}

Status InteractingVehicle::usable() const {
  if (!is_of_this_process()) {
    return Failure{Failure::Kind::kInvalid, "this vehicle belongs to process " +
                                                std::to_string(process_) +
                                                "; a forked child must make its own connection"};
  }
  const std::lock_guard lock(mutex_);
  return over_ ? Status(*over_) : ok_status();
}

// --- sensors ------------------------------------------------------------------------------------

Status InteractingVehicle::set_queue(std::string_view sensor, std::uint32_t depth) {
  const auto invalid = [&](const std::string& problem) {
    return Failure{Failure::Kind::kInvalid, "'" + std::string(sensor) + "' " + problem};
  };
  const uav::SensorDescription* const found = catalogue_.find_sensor(sensor);
  if (found == nullptr) return invalid("is no sensor of this UAV");
  if (found->rate_hz <= 0.0) return invalid("measures on demand, so it has no queue");
  if (depth < 1 || depth > link::kMaxQueue)
    return invalid("cannot have a queue of " +
                   std::to_string(static_cast<std::int32_t>(depth)) +  // as callers in C wrote it
                   " measurements; use 1 to " + std::to_string(link::kMaxQueue));
  queues_[static_cast<std::size_t>(found - catalogue_.sensors.data())] = depth;
  return ok_status();
}

std::uint32_t InteractingVehicle::queue_of(std::string_view sensor) const {
  const uav::SensorDescription* const found = catalogue_.find_sensor(sensor);
  return found == nullptr
             ? 1
             : queues_[static_cast<std::size_t>(found - catalogue_.sensors.data())].load();
}

Result<std::uint32_t> InteractingVehicle::find_periodic(std::string_view sensor) const {
  const uav::SensorDescription* const found = catalogue_.find_sensor(sensor);
  if (found == nullptr || found->rate_hz <= 0.0)
    return Failure{Failure::Kind::kInvalid,
                   "'" + std::string(sensor) + "' is no periodic sensor of this UAV"};
  return static_cast<std::uint32_t>(found - catalogue_.sensors.data());
}

Status InteractingVehicle::skip(std::string_view sensor) {
  const auto index = find_periodic(sensor);
  if (!index) return index.failure();
  return status_of(
      interact(link::ReadSensor{.sensor = *index, .queue = queues_[*index], .skips = true}));
}

Result<uav::Sample> InteractingVehicle::read_any(std::string_view sensor, uav::SensorKind kind,
                                                 Read read) {
  const uav::SensorDescription* const found = catalogue_.find_sensor(sensor);
  if (found == nullptr || found->kind() != kind) return no_such_sensor(sensor, kind);
  if (read == Read::kIfAvailable && found->rate_hz <= 0.0) {
    return Failure{Failure::Kind::kInvalid,
                   "'" + found->name +
                       "' measures on demand, so no measurement is available before the call. "
                       "Read it with kNext or kLatest"};
  }
  const auto index = static_cast<std::uint32_t>(found - catalogue_.sensors.data());
  auto reply = interact(
      link::ReadSensor{index, read == Read::kLatest, read == Read::kIfAvailable, queues_[index]});
  if (!reply) return reply.failure();
  return take_sample(std::move(*reply), *found, read);
}

Result<uav::Sample> InteractingVehicle::take_sample(link::Reply reply,
                                                    const uav::SensorDescription& sensor,
                                                    Read read) {
  if (!reply.sample && read == Read::kIfAvailable) {
    return Failure{Failure::Kind::kNothingYet, "'" + sensor.name + "' has no new measurement yet"};
  }
  if (!reply.sample || reply.sample->index() != static_cast<std::size_t>(sensor.kind()))
    return give_up(protocol_failure("it has no sample of sensor '" + sensor.name + "'"));
  if (const Status good = check_image(*reply.sample, sensor); !good) return give_up(good.failure());
  return std::move(*reply.sample);
}

Failure InteractingVehicle::no_such_sensor(std::string_view sensor, uav::SensorKind kind) const {
  std::string available;
  for (const auto& s : catalogue_.sensors) {
    available += (available.empty() ? "" : ", ") + std::string(s.kind_name()) + " '" + s.name + "'";
  }
  return {Failure::Kind::kInvalid, "there is no " + std::string(uav::name(kind)) + " '" +
                                       std::string(sensor) + "'; this UAV has " +
                                       (available.empty() ? "no sensors" : available)};
}

Result<uav::BatterySample> InteractingVehicle::read_battery() {
  if (catalogue_.battery_capacity_C <= 0.0) {
    return Failure{Failure::Kind::kInvalid,
                   "this UAV has no battery: its scenario has no 'energy' for it, or its simulator "
                   "does not simulate batteries"};
  }
  auto reply = interact(link::ReadBattery{});
  if (!reply) return reply.failure();
  if (!reply->battery) return give_up(protocol_failure("it has no state of the battery"));
  return *reply->battery;
}

// --- radio --------------------------------------------------------------------------------------

Status InteractingVehicle::send(std::string_view to, std::span<const std::uint8_t> bytes) {
  if (!to.empty() && std::find(peers_.begin(), peers_.end(), to) == peers_.end()) {
    std::string others;
    for (const std::string& peer : peers_) others += (others.empty() ? "'" : ", '") + peer + "'";
    return Failure{Failure::Kind::kInvalid,
                   "there is no other UAV '" + std::string(to) + "'; " +
                       (others.empty() ? "this is the only one" : "the others are " + others)};
  }
  if (peers_.empty())
    return Failure{Failure::Kind::kInvalid, "there is no other UAV to send a message to"};
  if (bytes.size() > link::kMaxRadioBytes)
    return Failure{Failure::Kind::kInvalid,
                   "a message has " + std::to_string(bytes.size()) + " bytes; at most " +
                       std::to_string(link::kMaxRadioBytes) + " are allowed"};
  return status_of(interact(link::SendMessage{std::string(to), {bytes.begin(), bytes.end()}}));
}

Result<RadioMessage> InteractingVehicle::receive(Duration timeout) {
  auto messages = receive_or_measure(timeout, {}, 1);
  if (!messages) return messages.failure();
  return std::move(messages->front());
}

// Without a message, a reply before the timeout is there for a sensor.
Result<std::vector<RadioMessage>> InteractingVehicle::receive_or_measure(
    Duration timeout, std::span<const std::string_view> sensors, std::uint32_t most) {
  const Duration longest{link::kMaxTimestampNs / 2};
  link::ReceiveMessage receive{std::clamp(timeout, Duration::zero(), longest), {}, most};
  for (const std::string_view name : sensors) {
    const auto index = find_periodic(name);
    if (!index) return index.failure();
    receive.sensors.push_back(*index);
  }
  // Reading a scripted clock takes its time, so only who waits for sensors reads it.
  const ExecTime timed_out_at = sensors.empty() ? ExecTime{} : now() + receive.timeout;
  auto reply = interact(std::move(receive));
  if (!reply) return reply.failure();
  std::vector<RadioMessage> received;
  if (!reply->message && reply->resume_at < timed_out_at) return received;
  if (!reply->message)
    return Failure{Failure::Kind::kNothingYet, "no message has arrived by the timeout"};
  const auto take = [&](link::RadioMessage& message) {
    received.push_back(
        {std::move(message.from), message.sent_at, message.arrived_at, std::move(message.bytes)});
  };
  take(*reply->message);
  std::ranges::for_each(reply->more, take);
  return received;
}

// --- commands and the end -----------------------------------------------------------------------

Status InteractingVehicle::command_velocity(const uav::VelocityCommand& command) {
  return commanded(status_of(interact(link::SetVelocity{command})));
}

Status InteractingVehicle::follow(std::span<const uav::TimedSetpoint> trajectory) {
  if (const std::string wrong = complaint_about(trajectory, catalogue_.limits); !wrong.empty())
    return commanded(Failure{Failure::Kind::kInvalid, "the command is invalid: " + wrong});
  if (trajectory.size() == 1 && trajectory[0].after == Duration(0))
    if (const auto velocity = heading_velocity(trajectory[0].setpoint))
      return command_velocity(*velocity);
  link::SetTrajectory set;
  for (const auto& [after, setpoint] : trajectory)
    set.setpoints.push_back({after, without_ignored(setpoint)});
  return commanded(status_of(interact(std::move(set))));
}

Status InteractingVehicle::commanded(Status status) {
  if (!status && status.failure().kind == Failure::Kind::kInvalid) ++refused_commands_;
  return status;
}

// What a program may ignore and say that it has reached its goal, and what leaves open why it has
// not.
std::string InteractingVehicle::report() const {
  const Duration beside = computed_beside(), others = computed_by_others();
  const double reads = static_cast<double>(clock_reads_);
  // A scripted clock goes on when it is read: not without something to compare with it.
  const bool is_any = std::max(beside, others) >= kLeastUncharged || reads >= uav::kPollingClock_hz;
  const Duration et = is_any ? now().time_since_epoch() : Duration(0);
  const auto in_ms = [&](Duration time, std::int64_t least_part) {
    const bool is_much = time >= kLeastUncharged && time * least_part > et;
    return is_much ? time / std::chrono::milliseconds(1) : 0;
  };
  const auto uncharged_ms = in_ms(beside, kLeastPartUncharged);
  const auto others_ms = in_ms(others, kLeastPartOfOthers);
  const double read_hz = reads / std::max(1.0, to_seconds(et));
  const auto clock_read_hz = read_hz > uav::kPollingClock_hz ? std::lround(read_hz) : 0;
  if (refused_commands_ == 0 && uncharged_ms == 0 && others_ms == 0 && clock_read_hz == 0)
    return "";
  return "{\"refused_commands\": " + std::to_string(refused_commands_) +
         ", \"uncharged_ms\": " + std::to_string(uncharged_ms) +
         ", \"others_ms\": " + std::to_string(others_ms) +
         ", \"clock_read_hz\": " + std::to_string(clock_read_hz) + "}";
}

Status InteractingVehicle::finish(bool reached_goal, std::string_view outcome,
                                  std::string_view details_json) {
  if (const std::string notes = report(); !notes.empty())
    if (const Status noted = annotate(uav::kClientReport, notes); !noted) return noted;
  Status done = status_of(
      interact(link::Finish{reached_goal, std::string(outcome), std::string(details_json)}));
  if (done) close();
  return done;
}

}  // namespace tether::client
