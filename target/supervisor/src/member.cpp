#include "member.h"

#include "membership.h"

#include <algorithm>
#include <utility>
#include <variant>

#include <signal.h>
#include <stdio.h>

#include <tether/client/simulated_vehicle.h>

namespace tether::supervisor {
namespace {

using client::ClockState;
using client::read_monotonic;

constexpr Duration kConnectTimeout = std::chrono::seconds(10);
/// A command that is told to end may take so long before it is killed, half of it stopped.
constexpr Duration kGrace = std::chrono::seconds(2);

}  // namespace

Member::Member(const Settings& settings, Started command, const client::SharedClockPage& clock,
               Say say)
    : settings_(settings),
      clock_(clock),
      uav_(std::move(command.uav)),
      process_(command.process),
      callers_(std::move(command.listener), clock.descriptor),
      errors_(std::move(command.errors)),
      starter_(std::move(command.starter)),
      say_(std::move(say)),
      joining_(client::ConnectOptions().welcome_timeout) {
  if (errors_)
    say_ = [this](const std::string& text) {
      ::dprintf(errors_.get(), "tether-exec: %s\n", text.c_str());
    };
}

void Member::add_to(std::vector<pollfd>& entries, bool runs) const {
  if (starter_) entries.push_back({starter_.get(), POLLIN, 0});
  if (channel_) entries.push_back({channel_->descriptor(), POLLIN, 0});
  if (runs && !exit_code_) callers_.add_to(entries);
}

// --- the callers --------------------------------------------------------------------------------

Callers::Events Member::caller_events() {
  return {
      [this](CallerId caller, link::Message message) { on_message(caller, std::move(message)); },
      [this](CallerId caller) {
        if (supervision_) supervision_->gone(caller);
      }};
}

void Member::hear_callers(const std::vector<pollfd>& entries) {
  callers_.receive(entries, caller_events());
}

void Member::hear_all_callers() {
  callers_.receive_all(caller_events());
}

void Member::on_message(CallerId caller, link::Message message) {
  if (auto* hello = std::get_if<link::Hello>(&message)) return on_hello(caller, *hello);
  auto* const request = std::get_if<link::Request>(&message);
  auto* const annotation = std::get_if<link::Annotation>(&message);
  if (supervision_ && request != nullptr) return supervision_->asked(caller, std::move(*request));
  if (supervision_ && annotation != nullptr) return supervision_->annotated(std::move(*annotation));
  callers_.drop(caller);
}

void Member::refuse(CallerId caller, const link::Refusal& why) {
  static_cast<void>(callers_.send(caller, why));
}

void Member::on_hello(CallerId caller, const link::Hello& hello) {
  using Reason = link::Refusal::Reason;
  if (hello.protocol_version != link::kProtocolVersion) {
    return refuse(caller, {Reason::kVersion,
                           "tether-exec and the program's library have different protocol "
                           "versions"});
  }
  if (!uav_.empty() && !hello.uav.empty() && hello.uav != uav_) {
    return refuse(caller, {Reason::kUav, "this tether-exec is for UAV '" + uav_ + "'"});
  }
  if (welcome_) return static_cast<void>(callers_.send(caller, *welcome_));
  if (refusal_) return refuse(caller, *refusal_);
  waiting_.push_back(caller);
  if (!channel_) connect(hello);
}

void Member::hand_out_answers() {
  if (!supervision_) return;
  for (Answer& answer : supervision_->take_answers()) {
    if (answer.message) {
      callers_.send(answer.caller, *answer.message);
    } else {
      callers_.drop(answer.caller);
    }
  }
}

// --- the coordinator ----------------------------------------------------------------------------

void Member::connect(const link::Hello& hello) {
  auto channel = link::connect_tcp(settings_.coordinator, kConnectTimeout);
  if (!channel) return lose_coordinator(channel.failure());
  channel_ = std::move(*channel);
  link::Hello own;
  own.sut = hello.sut;
  own.uav = uav_.empty() ? hello.uav : uav_;
  own.clock = {computer::ClockKind::kWall, settings_.factor};
  own.token = settings_.token;
  own.concurrent = true;
  // If it does not go out, the coordinator may have said why before it closed.
  static_cast<void>(channel_->send(own));
  joining_.asked(read_monotonic());
}

void Member::hear_coordinator(const std::vector<pollfd>& entries) {
  if (!channel_) return;
  const bool is_readable = std::ranges::any_of(entries, [this](const pollfd& entry) {
    return entry.fd == channel_->descriptor() && entry.revents != 0;
  });
  while (is_readable && channel_) {
    auto message = channel_->receive_within(Duration::zero());
    if (message) {
      on_message(std::move(*message));
    } else if (message.failure().kind == Failure::Kind::kTimeout) {
      return;
    } else {
      return lose_coordinator(message.failure());
    }
  }
}

void Member::on_message(link::Message message) {
  Status good = ok_status();
  if (auto* refusal = std::get_if<link::Refusal>(&message)) return refuse_all(std::move(*refusal));
  auto* const welcome = std::get_if<link::Welcome>(&message);
  if (welcome != nullptr && !supervision_) return on_welcome(std::move(*welcome));
  const auto* const due = std::get_if<link::Due>(&message);
  auto* const reply = std::get_if<link::Reply>(&message);
  if (supervision_ && due != nullptr) {
    good = supervision_->heard(*due);
  } else if (supervision_ && reply != nullptr) {
    good = on_reply(std::move(*reply));
  } else {
    good = Failure{Failure::Kind::kProtocol,
                   "protocol violation: unexpected message from the coordinator"};
  }
  if (!good) lose_coordinator(good.failure());
}

void Member::on_welcome(link::Welcome welcome) {
  if (welcome.free_running && settings_.factor != 1.0) {
    return refuse_all({link::Refusal::Reason::kBadRequest,
                       "TETHER_CLOCK wall*FACTOR is not allowed in free-running mode, where ST "
                       "follows the wall clock"});
  }
  supervision_.emplace(welcome.free_running, welcome.start);
  joining_.over();
  welcome_ = std::move(welcome);
  for (const CallerId caller : std::exchange(waiting_, {})) callers_.send(caller, *welcome_);
}

// In free running, each reply tells ST.
Status Member::on_reply(link::Reply reply) {
  const ClockState st{reply.resume_at, read_monotonic(), clock_rate(), true};
  const Status good = supervision_->heard(std::move(reply));
  if (good && welcome_->free_running) clock_.page->publish(st);
  return good;
}

void Member::send_outgoing() {
  if (!supervision_) return;
  for (const link::Message& message : supervision_->take_outgoing()) {
    // The refusal that may be the reason is read next.
    if (channel_) static_cast<void>(channel_->send(message));
  }
}

void Member::lose_coordinator(const Failure& failure) {
  channel_.reset();
  joining_.over();
  const bool was_over = supervision_ && supervision_->is_over();
  if (supervision_) supervision_->end(std::nullopt);
  if (!was_over && !(supervision_ && supervision_->is_finished())) say_(failure.message);
  for (const CallerId caller : std::exchange(waiting_, {})) callers_.drop(caller);
}

void Member::refuse_all(link::Refusal refusal) {
  channel_.reset();
  joining_.over();
  if (supervision_) return supervision_->end(std::move(refusal));
  refusal_ = std::move(refusal);
  for (const CallerId caller : std::exchange(waiting_, {})) callers_.send(caller, *refusal_);
}

// --- the end ------------------------------------------------------------------------------------

void Member::ended(int code, const std::string& message) {
  exit_code_ = code;
  channel_.reset();
  joining_.over();
  if (supervision_) supervision_->end(std::nullopt);
  if (starter_) send_end(starter_.get(), {code, message});
  starter_ = os::FileDescriptor();
}

void Member::kill() const {
  if (!exit_code_) ::kill(-process_, SIGKILL);
}

void Member::interrupt(int signal) {
  if (exit_code_) return;
  if (interrupted_at_) return kill();
  interrupted_at_ = read_monotonic();
  joining_.over();
  ::kill(-process_, signal);
}

std::optional<Duration> Member::next_wake(Duration now) const {
  if (exit_code_ || !interrupted_at_) return std::nullopt;
  const bool half_over = now >= *interrupted_at_ + kGrace / 2;
  return *interrupted_at_ + (half_over ? kGrace : kGrace / 2);
}

void Member::check_interrupt(Duration now, bool runs) {
  if (exit_code_ || !interrupted_at_) return;
  const Duration since = now - *interrupted_at_;
  if (since >= kGrace / 2 && !runs)
    refuse_all({link::Refusal::Reason::kRunEnded, "tether-exec was interrupted"});
  if (since >= kGrace) kill();
}

}  // namespace tether::supervisor
