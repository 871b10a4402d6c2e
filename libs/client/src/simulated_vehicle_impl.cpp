#include "simulated_vehicle_impl.h"

#include "barrier_clock.h"

#include <algorithm>
#include <utility>
#include <variant>

namespace tether::client {
namespace {

/// The sensor kind that delivers a sample type; samples and sensor kinds are in the same order.
template <class Sample>
constexpr uav::SensorKind kind_of() {
  if constexpr (std::is_same_v<Sample, uav::CameraSample>) return uav::SensorKind::kCamera;
  if constexpr (std::is_same_v<Sample, uav::ImuSample>) return uav::SensorKind::kImu;
  return uav::SensorKind::kRange;
}

Failure protocol_failure(const std::string& what) {
  return {Failure::Kind::kProtocol, "the coordinator's reply cannot be used: " + what};
}

/// `et + duration` within what a message may carry.
ExecTime add_within_bounds(ExecTime et, Duration duration) {
  const ExecTime last = from_ns<ExecTime>(link::kMaxTimestampNs - 1);
  if (duration <= Duration::zero()) return et;
  return duration >= last - et ? last : et + duration;
}

}  // namespace

Failure to_failure(const link::Refusal& refusal) {
  const bool ended = refusal.reason == link::Refusal::Reason::kRunEnded;
  return {ended ? Failure::Kind::kRunEnded : Failure::Kind::kRefused, refusal.message};
}

SimulatedVehicle::SimulatedVehicle(std::unique_ptr<link::Channel> channel, link::Welcome welcome,
                                   std::unique_ptr<TimeSource> source,
                                   std::unique_ptr<WallTimer> wall, Duration progress_period)
    : channel_(std::move(channel)),
      catalogue_(std::move(welcome.catalogue)),
      source_(std::move(source)),
      wall_(std::move(wall)) {
  if (welcome.free_running) {
    auto clock = std::make_unique<FreeRunningClock>(*source_, *wall_, welcome.start);
    free_running_ = clock.get();
    clock_ = std::move(clock);
  } else {
    clock_ = std::make_unique<BarrierClock>(*source_, welcome.start);
  }
  if (progress_period > Duration::zero()) {
    progress_ = std::make_unique<ProgressReporter>(progress_period, *source_,
                                                   [this] { return report_progress(); });
  }
}

SimulatedVehicle::~SimulatedVehicle() {
  channel_->close();  // a reporter that is sending must not wait for the coordinator
  progress_.reset();
}

// --- interactions -------------------------------------------------------------------------------

Result<link::Reply> SimulatedVehicle::interact(Body body) {
  if (over_) return *over_;
  const ExecTime stamp = clock_->begin();
  const Duration issued = wall_->now();
  const link::Request request{sequence_ + 1, stamp, previous_round_trip_, std::move(body)};
  auto reply = ask(request);
  previous_round_trip_ = wall_->now() - issued;
  if (reply) {
    sequence_ = request.sequence;
  } else if (reply.failure().kind != Failure::Kind::kInvalid) {
    give_up(reply.failure());
  }
  clock_->end(reply ? reply->resume_at : stamp);
  return reply;
}

Result<link::Reply> SimulatedVehicle::ask(const link::Request& request) {
  Status sent = ok_status();
  {
    const std::lock_guard lock(sending_);
    sent = channel_->send(request);
  }
  if (!sent && sent.failure().kind == Failure::Kind::kInvalid) return sent.failure();
  // Even if the request did not go out: the coordinator may have said why before it closed.
  auto message = channel_->receive();
  if (message) {
    if (const auto* refusal = std::get_if<link::Refusal>(&*message)) return to_failure(*refusal);
  }
  if (!sent) return sent.failure();
  if (!message) return message.failure();
  auto* reply = std::get_if<link::Reply>(&*message);
  if (reply == nullptr) return protocol_failure("it is another kind of message");
  if (const Status good = check(*reply, request); !good) return good.failure();
  return std::move(*reply);
}

Status SimulatedVehicle::check(const link::Reply& reply, const link::Request& request) const {
  if (reply.sequence != request.sequence) {
    return protocol_failure("it answers request " + std::to_string(reply.sequence) + ", not " +
                            std::to_string(request.sequence));
  }
  if (free_running_ != nullptr) return ok_status();
  if (reply.resume_at < request.issued_at) return protocol_failure("it is from before the request");
  if (reply.sample && uav::sampled_at(*reply.sample) > same_instant(reply.resume_at)) {
    return protocol_failure("it carries data from the future");
  }
  return ok_status();
}

Failure SimulatedVehicle::give_up(Failure failure) {
  over_ = failure;
  return failure;
}

bool SimulatedVehicle::report_progress() {
  const std::lock_guard lock(sending_);
  const auto reached = clock_->while_computing();
  return !reached || channel_->send(link::Progress{*reached}).ok();
}

// --- sensors ------------------------------------------------------------------------------------

template <class Sample>
Result<Sample> SimulatedVehicle::read(std::string_view sensor, Read read) {
  const uav::SensorDescription* const found = catalogue_.find_sensor(sensor);
  if (found == nullptr || found->kind() != kind_of<Sample>()) {
    return no_such_sensor(sensor, kind_of<Sample>());
  }
  const auto index = static_cast<std::uint32_t>(found - catalogue_.sensors.data());
  auto reply = interact(link::ReadSensor{index, read == Read::kLatest});
  if (!reply) return reply.failure();
  auto* const sample = reply->sample ? std::get_if<Sample>(&*reply->sample) : nullptr;
  if (sample == nullptr) {
    return give_up(protocol_failure("it carries no sample of sensor '" + found->name + "'"));
  }
  if (const Status good = check(*reply->sample, *found); !good) return give_up(good.failure());
  return std::move(*sample);
}

Failure SimulatedVehicle::no_such_sensor(std::string_view sensor, uav::SensorKind kind) const {
  std::string available;
  for (const auto& s : catalogue_.sensors) {
    available +=
        (available.empty() ? "" : ", ") + std::string(uav::name(s.kind())) + " '" + s.name + "'";
  }
  return {Failure::Kind::kInvalid, "there is no " + std::string(uav::name(kind)) + " '" +
                                       std::string(sensor) + "'; this UAV has " +
                                       (available.empty() ? "no sensors" : available)};
}

Status SimulatedVehicle::check(const uav::Sample& sample,
                               const uav::SensorDescription& sensor) const {
  const auto* image = std::get_if<uav::CameraSample>(&sample);
  const auto* camera = std::get_if<uav::CameraProperties>(&sensor.properties);
  if (image == nullptr || camera == nullptr) return ok_status();
  if (image->width_px == camera->model.width_px && image->height_px == camera->model.height_px) {
    return ok_status();
  }
  return protocol_failure("its image is not of the size that the catalogue gives for '" +
                          sensor.name + "'");
}

Result<uav::CameraSample> SimulatedVehicle::read_camera(std::string_view sensor, Read read) {
  return this->read<uav::CameraSample>(sensor, read);
}
Result<uav::ImuSample> SimulatedVehicle::read_imu(std::string_view sensor, Read read) {
  return this->read<uav::ImuSample>(sensor, read);
}
Result<uav::RangeSample> SimulatedVehicle::read_range(std::string_view sensor, Read read) {
  return this->read<uav::RangeSample>(sensor, read);
}

// --- commands, waiting, words for the record ----------------------------------------------------

namespace {

Status status_of(const Result<link::Reply>& reply) {
  return reply ? ok_status() : Status(reply.failure());
}

}  // namespace

Status SimulatedVehicle::command_velocity(const uav::VelocityCommand& command) {
  return status_of(interact(link::SetVelocity{command}));
}

Status SimulatedVehicle::sleep_for(Duration duration) {
  if (over_) return *over_;
  return sleep_until(add_within_bounds(clock_->begin(), duration));
}

Status SimulatedVehicle::sleep_until(ExecTime until) {
  if (over_) return *over_;
  if (free_running_ != nullptr) {
    free_running_->sleep_until(until);
    return ok_status();
  }
  const ExecTime last = from_ns<ExecTime>(link::kMaxTimestampNs - 1);
  return status_of(interact(link::Sleep{std::clamp(until, ExecTime{}, last)}));
}

Status SimulatedVehicle::annotate(std::string_view topic, std::string_view json) {
  if (over_) return *over_;
  // The clock stands still meanwhile. In free running it does not; nothing is charged there.
  const ExecTime at = free_running_ == nullptr ? clock_->begin() : clock_->now();
  Status sent = ok_status();
  {
    const std::lock_guard lock(sending_);
    sent = channel_->send(link::Annotation{at, std::string(topic), std::string(json)});
  }
  if (free_running_ == nullptr) clock_->end(at);
  return sent;
}

Status SimulatedVehicle::finish(bool reached_goal, std::string_view outcome,
                                std::string_view details_json) {
  Status done = status_of(
      interact(link::Finish{reached_goal, std::string(outcome), std::string(details_json)}));
  if (done) {
    over_ = Failure{Failure::Kind::kInvalid, "the mission is finished; no call is possible"};
    channel_->close();
    progress_.reset();
  }
  return done;
}

}  // namespace tether::client
