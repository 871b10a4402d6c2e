#include "supervisor.h"

#include <algorithm>
#include <cerrno>
#include <utility>

#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/signalfd.h>
#include <sys/wait.h>
#include <unistd.h>

#include <tether/client/exec/local_socket.h>

// The loop of tether-exec, on one thread. Each round waits for signals, the coordinator, the
// programs' connections or the next due time; has each member pass messages to its Supervision;
// and carries out with the freezer and the shared clock page what Group decides: when all programs
// must stop and may continue. While they are stopped, their connections are not read, except once
// after each stop.
namespace tether::supervisor {
namespace {

using client::ClockState;
using client::read_monotonic;

/// How often the coordinator is told how far ET has come.
constexpr Duration kProgressPeriod = std::chrono::milliseconds(2);
/// In free running, where it is only a sign of life.
constexpr Duration kHeartbeatPeriod = std::chrono::milliseconds(500);

int exit_code_from(int status) {
  return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

/// Before the commands' threads, so that a stop comes when it is due. Returns what was allowed.
const char* raise_priority() {
  ::prctl(PR_SET_TIMERSLACK, 1);
  sched_param parameters{};
  parameters.sched_priority = 1;
  if (::sched_setscheduler(0, SCHED_FIFO, &parameters) == 0) return "real-time priority";
  if (::setpriority(PRIO_PROCESS, 0, -20) == 0) return "nice -20";
  return "ordinary priority (neither SCHED_FIFO nor a nice below 0 is allowed)";
}

}  // namespace

Supervisor::Supervisor(const Settings& settings, Surroundings& surroundings, Say say)
    : settings_(settings),
      around_(surroundings),
      say_(std::move(say)),
      expected_(settings.members == 0 ? 1 : static_cast<std::size_t>(settings.members)) {}

int Supervisor::run() {
  while (!is_complete() || !have_all_ended()) {
    wait();
    take_signals();
    hear_starters();
    for (auto& member : members_) member->hear_coordinator(entries_);
    group_.pass_dues();
    if (runs())
      for (auto& member : members_) member->hear_callers(entries_);
    begin();
    hold_while_joining();
    stop_if_due();
    if (failed_) return 3;
    report_progress();
    for (auto& member : members_) member->send_outgoing();
    go_on();
    for (auto& member : members_) {
      member->hand_out_answers();
      member->check_interrupt(read_monotonic(), runs());
    }
  }
  return settings_.members == 0 && !members_.empty() ? *members_.front()->exit_code() : 0;
}

std::string Supervisor::statistics() const {
  return statistics_.report(around_.clock.page->now().time_since_epoch()) + "  with " + priority_;
}

// --- members ------------------------------------------------------------------------------------

Status Supervisor::start() {
  Program program;
  program.uav = settings_.uav;
  program.command.words = settings_.command;
  os::FileDescriptor none;
  return add(program, none);
}

Status Supervisor::add(Program& program, os::FileDescriptor& starter) {
  const std::string path = around_.folder + "/" + std::to_string(members_.size());
  auto listener = client::listen_local(path);
  if (!listener) return listener.failure();
  const auto command = start_command(program.command, path, around_.cgroup);
  if (!command) {
    ::unlink(path.c_str());  // for the next one
    return command.failure();
  }
  around_.guardian.watch(*command);
  around_.freezer->add(*command);
  members_.push_back(
      std::make_unique<Member>(settings_,
                               Started{program.uav, *command, std::move(*listener),
                                       std::move(program.descriptors[3]), std::move(starter)},
                               around_.clock, say_));
  // After the commands have started, because they would inherit it.
  if (is_complete()) priority_ = raise_priority();
  return ok_status();
}

bool Supervisor::have_all_ended() const {
  return std::ranges::all_of(members_,
                             [](const auto& member) { return member->exit_code().has_value(); });
}

void Supervisor::hear_starters() {
  if (!listener_) return;
  while (os::FileDescriptor accepted = client::accept_local(listener_))
    starters_.push_back(std::move(accepted));
  std::erase_if(starters_, [this](os::FileDescriptor& starter) { return take_program(starter); });
  for (auto& member : members_) hear_starter(*member);
}

/// False: it has not sent its program yet.
bool Supervisor::take_program(os::FileDescriptor& starter) {
  auto program = receive_program(starter.get());
  if (!program && program.failure().kind == Failure::Kind::kTimeout) return false;
  if (!program) return true;  // gone
  const auto refuse = [&](int code, const std::string& why) {
    send_end(starter.get(), {code, why});
    return true;
  };
  const bool is_known = std::ranges::any_of(
      members_, [&](const auto& member) { return member->uav() == program->uav; });
  if (is_complete()) return refuse(3, "the group has all of its members");
  if (is_known) return refuse(3, "the group already has a program for UAV '" + program->uav + "'");
  if (const Status started = add(*program, starter); !started) {
    ++failed_to_start_;
    return refuse(2, started.failure().message);
  }
  return true;
}

// The member's process passes signals on. If it is gone, nobody wants the command any more.
void Supervisor::hear_starter(Member& member) {
  while (member.starter() >= 0) {
    const auto signal = receive_signal(member.starter());
    if (signal == 0) return;
    if (!signal) {
      member.kill();
      return;
    }
    member.interrupt(*signal);
  }
}

// --- waiting ------------------------------------------------------------------------------------

void Supervisor::wait() {
  entries_.assign({{around_.signals.get(), POLLIN, 0}});
  if (listener_) entries_.push_back({listener_.get(), POLLIN, 0});
  for (const auto& starter : starters_) entries_.push_back({starter.get(), POLLIN, 0});
  for (const auto& member : members_) member->add_to(entries_, runs());
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
  const auto consider = [&wake](std::optional<Duration> instant) {
    if (instant && (!wake || *instant < *wake)) wake = instant;
  };
  const Duration now = read_monotonic();
  bool is_over = true;
  for (const auto& member : members_) {
    consider(member->next_wake(now));
    if (held_) consider(member->joining().until());
    if (Supervision* supervision = member->supervision(); supervision && !supervision->is_over())
      is_over = false;
  }
  if (!has_begun_ || !group_.is_running() || is_over) return wake;
  consider(next_progress_);
  if (const auto stop = group_.stop_at()) consider(around_.clock.page->state().mono_at(*stop));
  return wake;
}

void Supervisor::take_signals() {
  signalfd_siginfo info{};
  while (::read(around_.signals.get(), &info, sizeof info) == static_cast<ssize_t>(sizeof info)) {
    if (info.ssi_signo == SIGCHLD) {
      reap();
      continue;
    }
    expected_ = members_.size() + failed_to_start_;  // no more are wanted
    for (auto& member : members_) member->interrupt(static_cast<int>(info.ssi_signo));
  }
}

// What is left of a command's process group is killed, and what has left that, with the last one.
void Supervisor::reap() {
  int status = 0;
  for (pid_t ended = 0; (ended = ::waitpid(-1, &status, WNOHANG)) > 0;) {
    for (auto& member : members_) {
      if (member->process() != ended || member->exit_code()) continue;
      member->kill();
      member->ended(exit_code_from(status));
      around_.freezer->remove(ended);
      around_.guardian.forget(ended);
    }
  }
}

// --- stopping and going on ----------------------------------------------------------------------

/// From when all members have asked to join until all have got their answer. Not earlier: the first
/// one would keep the others from asking.
bool Supervisor::must_hold(Duration now) const {
  return is_complete() &&
         std::ranges::none_of(members_, [](const auto& m) { return m->joining().is_to_come(); }) &&
         std::ranges::any_of(members_,
                             [&](const auto& m) { return m->joining().must_be_stopped(now); });
}

/// ET starts when all that have asked to join have got their answer.
void Supervisor::begin() {
  const bool is_awaited = std::ranges::any_of(
      members_, [](const auto& member) { return member->joining().until().has_value(); });
  if (is_awaited) return;
  const bool begins = !has_begun_;
  for (auto& member : members_) {
    Supervision* const supervision = member->supervision();
    if (!supervision || supervision->is_over() || group_.has(*supervision)) continue;
    if (!begins) {
      member->refuse_all({link::Refusal::Reason::kBadRequest,
                          "the other programs of the group have begun without this one"});
      continue;
    }
    group_.add(*supervision);
    const link::Welcome& welcome = member->welcome();
    const Duration now = read_monotonic();
    progress_period_ = welcome.free_running ? kHeartbeatPeriod : kProgressPeriod;
    next_progress_ = now + progress_period_;
    around_.clock.page->publish({welcome.start, now, member->clock_rate(), true});
    has_begun_ = true;
  }
}

void Supervisor::hold_while_joining() {
  const bool must = must_hold(read_monotonic());
  if (must == held_) return;
  held_ = must;
  if (!held_) return around_.freezer->thaw();
  if (const Status frozen = around_.freezer->freeze(); !frozen) return give_up(frozen.failure());
  for (auto& member : members_) member->hear_all_callers();
}

void Supervisor::stop_if_due() {
  if (has_begun_ && runs() && group_.must_stop(around_.clock.page->now())) stop();
}

void Supervisor::stop() {
  const auto due = group_.stop_at();
  const Duration began = read_monotonic();
  if (const Status frozen = around_.freezer->freeze(); !frozen) return give_up(frozen.failure());
  const Duration mono = read_monotonic();
  const ClockState state = around_.clock.page->state();
  const ExecTime at = state.at(mono) + Duration(1);  // later than each stamp
  around_.clock.page->publish({at, mono, state.factor, false});
  statistics_.froze(mono - began);
  if (due && at >= *due) statistics_.overshot(at - *due);
  for (auto& member : members_) member->hear_all_callers();
  group_.stopped(at);
}

// The coordinator hears nothing more: from how far ET has come meanwhile it would conclude that the
// program was slow, not that it is lost.
void Supervisor::give_up(const Failure& failure) {
  say_(failure.message + "; the command is killed");
  failed_ = true;
  for (auto& member : members_) {
    member->kill();
    member->ended(3, failure.message + "; the command is killed");
  }
}

void Supervisor::go_on() {
  if (group_.is_running() || !group_.may_go_on()) return;
  group_.go_on();
  for (auto& member : members_) member->hand_out_answers();
  // ET goes on before the threads do: the time that a thaw takes is charged, not given away.
  const Duration began = read_monotonic();
  around_.clock.page->publish({group_.stopped_at(), began, settings_.factor, true});
  around_.freezer->thaw();
  const Duration now = read_monotonic();
  statistics_.thawed(now - began);
  next_progress_ = now + progress_period_;
}

void Supervisor::report_progress() {
  if (!has_begun_ || !runs() || read_monotonic() < next_progress_) return;
  const ExecTime now = around_.clock.page->now();
  for (auto& member : members_)
    if (Supervision* const supervision = member->supervision()) supervision->progressed(now);
  next_progress_ = read_monotonic() + progress_period_;
}

}  // namespace tether::supervisor
