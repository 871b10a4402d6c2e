#include "supervisor.h"

#include <algorithm>
#include <cerrno>
#include <utility>
#include <variant>

#include <signal.h>
#include <sys/signalfd.h>
#include <sys/wait.h>

#include <tether/client/simulated_vehicle.h>

// The loop of tether-exec, on one thread. Each round waits for signals, the coordinator, the
// program's connections or the next due time; passes messages to Supervision, which decides when
// the program must stop and may continue; and carries that out with the freezer and the shared
// clock page. While the program is stopped, its connections are not read, except once after each
// stop.
namespace tether::supervisor {
namespace {

using client::ClockState;
using client::read_monotonic;

/// How often the coordinator is told how far ET has come.
constexpr Duration kProgressPeriod = std::chrono::milliseconds(2);
/// In free running, where it is only a sign of life.
constexpr Duration kHeartbeatPeriod = std::chrono::milliseconds(500);
constexpr Duration kConnectTimeout = std::chrono::seconds(10);
/// A command that is told to end may take so long before it is killed, half of it stopped.
constexpr Duration kGrace = std::chrono::seconds(2);

int exit_code_from(int status) {
  return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

}  // namespace

Supervisor::Supervisor(const Settings& settings, pid_t command, client::SharedClockPage clock,
                       os::FileDescriptor listener, os::FileDescriptor signals,
                       std::unique_ptr<Freezer> freezer, Say say)
    : settings_(settings),
      command_(command),
      clock_(std::move(clock)),
      signals_(std::move(signals)),
      freezer_(std::move(freezer)),
      callers_(std::move(listener), clock_.descriptor),
      say_(std::move(say)),
      joining_(client::ConnectOptions().welcome_timeout) {}

int Supervisor::run() {
  while (!exit_code_) {
    wait();
    take_signals();
    hear_coordinator();
    hear_callers();
    hold_while_joining();
    stop_if_due();
    if (failed_) break;
    report_progress();
    send_outgoing();
    go_on();
    hand_out_answers();
    check_interrupt();
  }
  return failed_ ? 3 : *exit_code_;
}

std::string Supervisor::statistics() const {
  return statistics_.report(clock_.page->now().time_since_epoch());
}

// --- waiting ------------------------------------------------------------------------------------

void Supervisor::wait() {
  entries_.assign({{signals_.get(), POLLIN, 0}});
  entries_.push_back({channel_ ? channel_->descriptor() : -1, POLLIN, 0});
  // While the group is stopped, it sends nothing.
  if (group_runs()) callers_.add_to(entries_);
  timespec timeout{};
  const auto wake = next_wake();
  if (wake) {
    const Duration left = std::max(*wake - read_monotonic(), Duration::zero());
    timeout = {left.count() / 1'000'000'000, left.count() % 1'000'000'000};
  }
  if (::ppoll(entries_.data(), entries_.size(), wake ? &timeout : nullptr, nullptr) >= 0) return;
  for (pollfd& entry : entries_) entry.revents = 0;  // interrupted
}

std::optional<Duration> Supervisor::next_wake() const {
  std::optional<Duration> wake;
  const auto consider = [&wake](Duration instant) {
    if (!wake || instant < *wake) wake = instant;
  };
  if (interrupted_at_) {
    const bool half_over = read_monotonic() >= *interrupted_at_ + kGrace / 2;
    consider(*interrupted_at_ + (half_over ? kGrace : kGrace / 2));
  }
  if (const auto until = joining_.until(); held_ && until) consider(*until);
  if (!supervision_ || !supervision_->is_running() || supervision_->is_over()) return wake;
  consider(next_progress_);
  if (const auto stop = supervision_->stop_at()) consider(clock_.page->state().mono_at(*stop));
  return wake;
}

void Supervisor::take_signals() {
  signalfd_siginfo info{};
  while (::read(signals_.get(), &info, sizeof info) == static_cast<ssize_t>(sizeof info)) {
    if (info.ssi_signo == SIGCHLD) {
      reap();
    } else {
      interrupt(static_cast<int>(info.ssi_signo));
    }
  }
}

void Supervisor::reap() {
  int status = 0;
  for (pid_t ended = 0; (ended = ::waitpid(-1, &status, WNOHANG)) > 0;) {
    if (ended == command_) exit_code_ = exit_code_from(status);
  }
}

void Supervisor::interrupt(int signal) {
  if (interrupted_at_) {
    ::kill(-command_, SIGKILL);
    return;
  }
  interrupted_at_ = read_monotonic();
  joining_.over();
  ::kill(-command_, signal);
}

// The command hears the signal when it runs next: as soon as the coordinator lets it or, if that
// takes half of its time, without.
void Supervisor::check_interrupt() {
  if (!interrupted_at_) return;
  const Duration since = read_monotonic() - *interrupted_at_;
  if (since >= kGrace / 2 && !group_runs()) {
    refuse_all({link::Refusal::Reason::kRunEnded, "tether-exec was interrupted"});
  }
  if (since >= kGrace) ::kill(-command_, SIGKILL);
}

// --- the callers --------------------------------------------------------------------------------

Callers::Events Supervisor::caller_events() {
  return {
      [this](CallerId caller, link::Message message) { on_message(caller, std::move(message)); },
      [this](CallerId caller) {
        if (supervision_) supervision_->gone(caller);
      }};
}

void Supervisor::hear_callers() {
  if (group_runs()) callers_.receive(entries_, caller_events());
}

void Supervisor::on_message(CallerId caller, link::Message message) {
  if (auto* hello = std::get_if<link::Hello>(&message)) return on_hello(caller, *hello);
  auto* const request = std::get_if<link::Request>(&message);
  auto* const annotation = std::get_if<link::Annotation>(&message);
  if (supervision_ && request != nullptr) return supervision_->asked(caller, std::move(*request));
  if (supervision_ && annotation != nullptr) return supervision_->annotated(std::move(*annotation));
  callers_.drop(caller);
}

void Supervisor::on_hello(CallerId caller, const link::Hello& hello) {
  using Reason = link::Refusal::Reason;
  if (hello.protocol_version != link::kProtocolVersion) {
    return callers_.send(caller, link::Refusal{Reason::kVersion,
                                               "tether-exec and the program's library have "
                                               "different protocol versions"});
  }
  if (!settings_.uav.empty() && !hello.uav.empty() && hello.uav != settings_.uav) {
    return callers_.send(
        caller, link::Refusal{Reason::kUav, "this tether-exec is for UAV '" + settings_.uav + "'"});
  }
  if (welcome_) return callers_.send(caller, *welcome_);
  if (refusal_) return callers_.send(caller, *refusal_);
  waiting_.push_back(caller);
  if (!channel_) connect(hello);
}

void Supervisor::hand_out_answers() {
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

void Supervisor::connect(const link::Hello& hello) {
  auto channel = link::connect_tcp(settings_.coordinator, kConnectTimeout);
  if (!channel) return lose_coordinator(channel.failure());
  channel_ = std::move(*channel);
  link::Hello own;
  own.sut = hello.sut;
  own.uav = settings_.uav.empty() ? hello.uav : settings_.uav;
  own.clock = link::ClockKind::kWall;
  own.cpu_factor = settings_.factor;
  own.token = settings_.token;
  own.concurrent = true;
  // If it does not go out, the coordinator may have said why before it closed.
  static_cast<void>(channel_->send(own));
  joining_.asked(read_monotonic());
}

void Supervisor::hear_coordinator() {
  if (!channel_ || entries_[1].revents == 0) return;
  while (channel_) {
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

void Supervisor::on_message(link::Message message) {
  Status good = ok_status();
  if (auto* refusal = std::get_if<link::Refusal>(&message)) return refuse_all(std::move(*refusal));
  auto* const welcome = std::get_if<link::Welcome>(&message);
  if (welcome != nullptr && !supervision_) return on_welcome(std::move(*welcome));
  const auto* const due = std::get_if<link::Due>(&message);
  auto* const reply = std::get_if<link::Reply>(&message);
  if (supervision_ && due != nullptr) {
    good = supervision_->heard(*due);
  } else if (supervision_ && reply != nullptr) {
    good = supervision_->heard(std::move(*reply));
  } else {
    good = Failure{Failure::Kind::kProtocol,
                   "protocol violation: unexpected message from the coordinator"};
  }
  if (!good) lose_coordinator(good.failure());
}

void Supervisor::on_welcome(link::Welcome welcome) {
  if (welcome.free_running && settings_.factor != 1.0) {
    return refuse_all({link::Refusal::Reason::kBadRequest,
                       "TETHER_CLOCK wall*FACTOR is not allowed in free-running mode, where ST "
                       "follows the wall clock"});
  }
  progress_period_ = welcome.free_running ? kHeartbeatPeriod : kProgressPeriod;
  next_progress_ = read_monotonic() + progress_period_;
  supervision_.emplace(welcome.free_running, welcome.start);
  clock_.page->publish({welcome.start, read_monotonic(), settings_.factor, true});
  joining_.over();
  welcome_ = std::move(welcome);
  for (const CallerId caller : std::exchange(waiting_, {})) callers_.send(caller, *welcome_);
}

void Supervisor::send_outgoing() {
  if (!supervision_) return;
  for (const link::Message& message : supervision_->take_outgoing()) {
    // The refusal that may be the reason is read next.
    if (channel_) static_cast<void>(channel_->send(message));
  }
}

void Supervisor::lose_coordinator(const Failure& failure) {
  channel_.reset();
  joining_.over();
  const bool was_over = supervision_ && supervision_->is_over();
  if (supervision_) supervision_->end(std::nullopt);
  if (!was_over && !(supervision_ && supervision_->is_finished())) say_(failure.message);
  for (const CallerId caller : std::exchange(waiting_, {})) callers_.drop(caller);
}

void Supervisor::refuse_all(link::Refusal refusal) {
  channel_.reset();
  joining_.over();
  if (supervision_) return supervision_->end(std::move(refusal));
  refusal_ = std::move(refusal);
  for (const CallerId caller : std::exchange(waiting_, {})) callers_.send(caller, *refusal_);
}

// --- stopping and going on ----------------------------------------------------------------------

void Supervisor::hold_while_joining() {
  const bool must_hold = joining_.must_be_stopped(read_monotonic());
  if (must_hold == held_) return;
  held_ = must_hold;
  if (!held_) return freezer_->thaw();
  if (const Status frozen = freezer_->freeze(); !frozen) return give_up(frozen.failure());
  callers_.receive_all(caller_events());
}

void Supervisor::stop_if_due() {
  if (!supervision_ || !supervision_->is_running()) return;
  if (supervision_->must_stop(clock_.page->now())) stop();
}

void Supervisor::stop() {
  const auto due = supervision_->stop_at();
  const Duration began = read_monotonic();
  if (const Status frozen = freezer_->freeze(); !frozen) return give_up(frozen.failure());
  const Duration mono = read_monotonic();
  ClockState state = clock_.page->state();
  const ExecTime at = state.at(mono);
  clock_.page->publish({at, mono, state.factor, false});
  statistics_.froze(mono - began);
  if (due && at >= *due) statistics_.overshot(at - *due);
  callers_.receive_all(caller_events());
  supervision_->stopped(at);
}

// The coordinator hears nothing more: from how far ET has come meanwhile it would conclude that the
// program was slow, not that it is lost.
void Supervisor::give_up(const Failure& failure) {
  say_(failure.message + "; the command is killed");
  failed_ = true;
  ::kill(-command_, SIGKILL);
  channel_.reset();
}

void Supervisor::go_on() {
  if (!supervision_ || group_runs() || !supervision_->may_go_on()) return;
  supervision_->go_on();
  hand_out_answers();
  // ET goes on before the threads do: the time that a thaw takes is charged, not given away.
  const Duration began = read_monotonic();
  clock_.page->publish({supervision_->stopped_at(), began, settings_.factor, true});
  freezer_->thaw();
  const Duration now = read_monotonic();
  statistics_.thawed(now - began);
  next_progress_ = now + progress_period_;
}

void Supervisor::report_progress() {
  if (!supervision_ || !group_runs() || read_monotonic() < next_progress_) return;
  supervision_->progressed(clock_.page->now());
  next_progress_ = read_monotonic() + progress_period_;
}

}  // namespace tether::supervisor
