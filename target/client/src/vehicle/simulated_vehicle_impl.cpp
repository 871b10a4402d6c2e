// Every call stops the clock, stamps the request, waits for the reply, and resumes the clock at the
// reply's timestamp: `interact` does this under the lock that makes calls of several threads wait
// for each other. The progress reporter stamps beside it, while the program computes.

#include "vehicle/simulated_vehicle_impl.h"

#include "clocks/barrier_clock.h"

#include <utility>
#include <variant>

namespace tether::client {
namespace {

constexpr const char* kOverlapReason =
    "a thread called the vehicle during another thread's call, and had to wait for it, as it would "
    "not on a board. Set `concurrent = true` under [sut], or let the threads take turns";

}  // namespace

SimulatedVehicle::SimulatedVehicle(std::unique_ptr<link::Channel> channel, link::Welcome welcome,
                                   std::unique_ptr<TimeSource> source,
                                   std::unique_ptr<WallTimer> wall, Duration progress_period)
    : InteractingVehicle(std::move(welcome.catalogue), std::move(welcome.peers)),
      channel_(std::move(channel)),
      source_(std::move(source)),
      wall_(std::move(wall)),
      free_running_(welcome.free_running),
      stages_(welcome.start),
      given_(std::move(welcome.computing)) {
  if (welcome.free_running) {
    clock_ = std::make_unique<FreeRunningClock>(*source_, *wall_, welcome.start,
                                                welcome.real_time_factor);
  } else {
    clock_ = std::make_unique<BarrierClock>(*source_, welcome.start);
  }
  if (progress_period > Duration::zero()) {
    progress_ = std::make_unique<ProgressReporter>(progress_period, *source_,
                                                   [this] { return report_progress(); });
  }
}

SimulatedVehicle::~SimulatedVehicle() {
  if (!is_of_this_process()) {
    // The connection is still the parent's, and the reporter's thread was never here to be joined.
    static_cast<void>(progress_.release());
    return;
  }
  channel_->close();  // a reporter that is sending must not wait for the coordinator
  progress_.reset();
}

// --- interactions -------------------------------------------------------------------------------

// Handlers that run while the clock is stopped would compute in no time, so they wait. The program
// can still be ended and stopped, and fail.
SimulatedVehicle::Call::Call(SimulatedVehicle& vehicle) {
  if (!vehicle.free_running_)
    signals_.emplace(std::initializer_list<int>{SIGINT, SIGTERM, SIGQUIT, SIGHUP, SIGTSTP, SIGTTIN,
                                                SIGTTOU, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGTRAP,
                                                SIGSYS, SIGABRT});
  lock_ = std::unique_lock(vehicle.calls_, std::try_to_lock);
  if (lock_.owns_lock()) return;
  vehicle.has_overlapping_calls_ = true;
  lock_.lock();
}

Result<link::Reply> SimulatedVehicle::interact(Body body) {
  if (const Status good = usable(); !good) return good.failure();
  const Call call(*this);
  return interact_alone(std::move(body));
}

Result<link::Reply> SimulatedVehicle::interact_alone(Body body) {
  if (const Status good = usable(); !good) return good.failure();  // others were first
  const ExecTime stamp = begin_call(body);
  if (const Status good = complete(); !good) return good.failure();
  const Duration issued = wall_->now();
  const std::string call = name_of_call(body, catalogue());
  const link::Request request{sequence_ + 1, stamp, previous_round_trip_, std::move(body),
                              stages_.times(link::stage_between(previous_call_, call))};
  auto reply = ask(request);
  previous_round_trip_ = wall_->now() - issued;
  if (reply) {
    sequence_ = request.sequence;
    stages_.resume(reply->resume_at);
    given_ = std::move(reply->computing);
    previous_call_ = call;
    if (std::holds_alternative<link::Finish>(request.body)) give_up(mission_finished());
  } else if (reply.failure().kind != Failure::Kind::kInvalid) {
    give_up(reply.failure());
  }
  clock_->end(reply ? reply->resume_at : stamp);
  return reply;
}

// Time that is replayed is charged before the clock is read. Otherwise nothing is done until then.
ExecTime SimulatedVehicle::begin_call(const Body& body) {
  if (source_->clock().kind == computer::ClockKind::kReplayed) {
    const std::string call = name_of_call(body, catalogue());
    source_->charge(stages_.take(given_, link::stage_between(previous_call_, call)));
    return clock_->begin();
  }
  const ExecTime stamp = clock_->begin();
  if (!free_running_) stages_.reach(stamp, source_->computed_by_parts());
  return stamp;
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
  if (reply == nullptr) return protocol_failure("it is not a Reply");
  if (const Status good = check(*reply, request, catalogue(), free_running_); !good)
    return good.failure();
  return std::move(*reply);
}

// A thread that waits for another one's call computes nothing meanwhile, as it would on a board:
// how long depends on the simulation. The coordinator ends the run with the reason.
Status SimulatedVehicle::complete() {
  Status good = source_->complete();
  if (good && has_overlapping_calls_ && !free_running_)
    good = Failure{Failure::Kind::kRefused, kOverlapReason};
  if (good) return good;
  give_up(good.failure());
  const std::lock_guard lock(sending_);
  static_cast<void>(
      channel_->send(link::Refusal{link::Refusal::Reason::kBadRequest, good.failure().message}));
  return good;
}

bool SimulatedVehicle::report_progress() {
  const std::lock_guard lock(sending_);
  const auto reached = clock_->while_computing();
  return !reached || channel_->send(link::Progress{*reached}).ok();
}

void SimulatedVehicle::close() {
  channel_->close();
  progress_.reset();
}

// --- waiting, words for the record --------------------------------------------------------------

Status SimulatedVehicle::sleep_for(Duration duration) {
  if (const Status good = usable(); !good) return good;
  const Call call(*this);
  if (const Status good = usable(); !good) return good;  // others were first
  return sleep_alone(add_within_bounds(begin_call(link::Sleep{}), duration), true);
}

Status SimulatedVehicle::sleep_until(ExecTime until) {
  if (const Status good = usable(); !good) return good;
  const Call call(*this);
  if (const Status good = usable(); !good) return good;  // others were first
  return sleep_alone(until, false);
}

Status SimulatedVehicle::sleep_alone(ExecTime until, bool is_relative) {
  link::Sleep sleep = make_sleep(until);
  sleep.is_relative = is_relative;
  return status_of(interact_alone(sleep));
}

Status SimulatedVehicle::annotate(std::string_view topic, std::string_view json) {
  if (const Status good = usable(); !good) return good;
  const Call call(*this);
  if (const Status good = usable(); !good) return good;  // others were first
  // Under the barrier the clock is stopped. In free-running mode no time is charged.
  const ExecTime at = free_running_ ? clock_->now() : clock_->begin();
  Status sent = ok_status();
  {
    const std::lock_guard sending(sending_);
    sent = channel_->send(link::Annotation{at, std::string(topic), std::string(json)});
  }
  if (!free_running_) clock_->end(at);
  return sent;
}

// --- stages -------------------------------------------------------------------------------------

// The clock stands still meanwhile. A scripted clock advances whenever it is read: it is not, and
// its step belongs to the stage of the next call.
template <class Change>
Status SimulatedVehicle::change_stage(Change change) {
  if (const Status good = usable(); !good) return good;
  const Call call(*this);
  if (const Status good = usable(); !good) return good;  // others were first
  if (free_running_) return change(stages_);
  if (source_->clock().computing > Duration::zero()) {
    stages_.reach(stages_.reached());
    return change(stages_);
  }
  if (source_->clock().kind == computer::ClockKind::kReplayed)
    source_->charge(stages_.take(given_, ""));
  const ExecTime at = clock_->begin();
  stages_.reach(at);
  const Status changed = change(stages_);
  clock_->end(at);
  return changed;
}

Status SimulatedVehicle::begin_stage(std::string_view stage) {
  return change_stage([&](StageLog& stages) { return stages.begin(stage); });
}

Status SimulatedVehicle::end_stage() {
  return change_stage([](StageLog& stages) { return stages.end(); });
}

}  // namespace tether::client
