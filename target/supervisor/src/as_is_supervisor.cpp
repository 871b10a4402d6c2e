#include "as_is_supervisor.h"

#include <algorithm>
#include <csignal>
#include <utility>
#include <variant>

#include <sys/signalfd.h>
#include <sys/wait.h>
#include <unistd.h>

#include <tether/client/exec/clock_page.h>
#include <tether/client/exec/group_page.h>
#include <tether/client/simulated_vehicle.h>

namespace tether::supervisor {
namespace {

using client::GroupEvent;
using client::GroupPage;

// Between two looks whether all wait [real time].
constexpr Duration kShortestSlice = std::chrono::microseconds(30);
constexpr Duration kLongestSlice = std::chrono::milliseconds(1);
// While one of the program's threads computes, what has arrived is taken so often [ET].
constexpr Duration kBetweenPulls = std::chrono::milliseconds(2);
// Processes that have ended are looked for so often [real time].
constexpr Duration kBetweenForgetting = std::chrono::milliseconds(10);
// A thread that was told just before it waited is told again [real time].
constexpr Duration kBetweenTellings = std::chrono::milliseconds(1);
// After so long it is told that nothing was used [ET].
constexpr Duration kIdle = std::chrono::seconds(10);
// Who computes so much has been woken.
constexpr Duration kLeastWoken = std::chrono::microseconds(100);
// Now and then, a thread can have begun to compute just after it was looked at.
constexpr int kWakes = 10;
// Of a wait without a deadline; then it begins again.
constexpr Duration kForEver = std::chrono::hours(1);

link::Reply reply_of(std::uint64_t sequence, ExecTime at) {
  link::Reply reply;
  reply.sequence = sequence;
  reply.resume_at = at;
  return reply;
}

}  // namespace

AsIsSupervisor::AsIsSupervisor(pid_t program, GroupPage& page,
                               std::unique_ptr<client::Vehicle> vehicle, double factor,
                               Callers& callers, const Own& own, Say say)
    : program_(program),
      page_(page),
      vehicle_(std::move(vehicle)),
      factor_(factor),
      callers_(callers),
      signals_(own.signals),
      threads_(own.guardian),
      say_(std::move(say)),
      computed_(own.computed) {
  publish();
}

std::optional<int> AsIsSupervisor::run() {
  while (!is_over_) {
    if (const auto status = reap()) return status;
    take_signals();
    hear();
    if (!unheard_.empty()) continue;
    if (is_pulling_) {
      is_pulling_ = receive(Duration(0));
      continue;
    }
    for (const Pull& pull : std::exchange(pulls_, {}))
      callers_.send(pull.caller, reply_of(pull.sequence, page_.now()));
    forget_processes();
    wake_overdue();
    if (!unheard_.empty()) continue;
    // In this order: one of those that wait may have asked this process for something.
    if (are_all_waiting() && !is_asked() && lead())
      patience_ = Duration(0);
    else
      pull_now_and_then();
  }
  return std::nullopt;
}

// A program that uses some of it is right: it need not use all.
void AsIsSupervisor::tell_if_idle() {
  if (is_known_to_be_used_) return;
  is_known_to_be_used_ = is_fed();
  if (is_known_to_be_used_ || page_.glance() < ExecTime(kIdle)) return;
  is_known_to_be_used_ = true;
  say_(
      "for 10 s the program has used nothing of the UAV: no UDP port of a companion (14540, "
      "14550), no serial port, and no camera");
}

bool AsIsSupervisor::is_fed() const {
  if (!reads_.empty()) return true;
  return std::ranges::any_of(page_.processes(), [](const GroupPage::Process& one) {
    return one.id > 0 && (one.listens || one.sensors != 0);
  });
}

void AsIsSupervisor::forget_processes() {
  const Duration now = client::read_monotonic();
  if (now - forgotten_at_ < kBetweenForgetting) return;
  forgotten_at_ = now;
  tell_if_idle();
  page_.forget_ended(computed_);
}

// Descendants whose own parent has ended are children of this process.
std::optional<int> AsIsSupervisor::reap() {
  for (;;) {
    siginfo_t ended{};
    if (::waitid(P_ALL, 0, &ended, WEXITED | WNOHANG | WNOWAIT) != 0 || ended.si_pid == 0)
      return std::nullopt;
    static_cast<void>(page_.used());  // its last computing
    int status = 0;
    ::waitpid(ended.si_pid, &status, 0);
    if (ended.si_pid == program_) return status;
  }
}

void AsIsSupervisor::take_signals() {
  signalfd_siginfo info{};
  while (::read(signals_.get(), &info, sizeof info) == static_cast<ssize_t>(sizeof info))
    if (info.ssi_signo != SIGCHLD)
      ::kill(-program_, interrupts_++ == 0 ? static_cast<int>(info.ssi_signo) : SIGKILL);
}

// --- the processes ------------------------------------------------------------------------------

/// Until the first deadline, if one of the program's threads computes all the time.
Duration AsIsSupervisor::slice() {
  patience_ = std::clamp(patience_ + patience_ / 4, kShortestSlice, kLongestSlice);
  const ExecTime first = page_.first_deadline();
  if (!unheard_.empty() || first == GroupPage::kNever) return patience_;
  const auto until_first = static_cast<double>((first - page_.glance()).count()) / factor_;
  return std::clamp(Duration(static_cast<std::int64_t>(until_first)), kShortestSlice, patience_);
}

std::vector<pollfd> AsIsSupervisor::ears() const {
  std::vector<pollfd> entries;
  entries.push_back({signals_.get(), POLLIN, 0});
  callers_.add_to(entries);
  return entries;
}

bool AsIsSupervisor::is_asked() const {
  std::vector<pollfd> entries = ears();
  return ::poll(entries.data(), entries.size(), 0) != 0;
}

void AsIsSupervisor::hear() {
  std::vector<pollfd> entries = ears();
  const timespec time{0, is_pulling_ && unheard_.empty() ? 0L : static_cast<long>(slice().count())};
  if (::ppoll(entries.data(), entries.size(), &time, nullptr) <= 0) return;
  patience_ = Duration(0);
  callers_.receive(entries, {[this](CallerId caller, link::Message message) {
                               on_message(caller, std::move(message));
                             },
                             [this](CallerId caller) { on_gone(caller); }});
}

void AsIsSupervisor::on_message(CallerId caller, link::Message message) {
  if (const auto* hello = std::get_if<link::Hello>(&message)) {
    if (hello->sut == client::kGroupAgent) agents_.insert(caller);
    if (hello->sut == client::kGroupEvents)
      lines_[caller] = static_cast<pid_t>(hello->process);
    else
      callers_.send(
          caller, link::Welcome{
                      .catalogue = vehicle_->catalogue(), .start = {}, .peers = vehicle_->peers()});
    return;
  }
  if (auto* request = std::get_if<link::Request>(&message))
    return on_request(caller, std::move(*request));
  if (const auto* annotation = std::get_if<link::Annotation>(&message)) {
    static_cast<void>(vehicle_->annotate(annotation->topic, annotation->json));
    return;
  }
  if (const auto heard = unheard_.find(caller); heard != unheard_.end()) unheard_.erase(heard);
}

// A receive of the preloaded library asks for what has arrived, for all processes. What lasts may
// not be passed on: deadlines of others would go by.
void AsIsSupervisor::on_request(CallerId caller, link::Request request) {
  if (const std::string reason = reason_to_refuse(caller, request.body); !reason.empty()) {
    callers_.send(caller, link::Refusal{link::Refusal::Reason::kBadRequest, reason});
    return;
  }
  if (std::holds_alternative<link::ReceiveMessage>(request.body)) {
    pulls_.push_back({caller, request.sequence});
    return pull();
  }
  is_known_to_be_used_ |= agents_.count(caller) == 0;
  const auto* const read = std::get_if<link::ReadSensor>(&request.body);
  if (read == nullptr || read->only_if_available || read->skips ||
      read->sensor >= vehicle_->catalogue().sensors.size())
    return answer(caller, request.sequence, std::move(request.body));
  tell_if_shared(caller, read->sensor);
  reads_.push_back({caller, request.sequence, *read});
  answer_reads();
}

// Seen by turns: one that reads after another, which has ended with it, shares nothing.
void AsIsSupervisor::tell_if_shared(CallerId caller, std::uint32_t sensor) {
  Readers& readers = readers_[sensor];
  const bool is_another = std::exchange(readers.last, caller) != caller;
  const bool is_first = readers.all.insert(caller).second;
  if (!is_another || is_first || std::exchange(readers.are_told, true)) return;
  doubt("has programs that share the measurements of sensor '" +
        vehicle_->catalogue().sensors[sensor].name +
        "': each goes to one of them only. Let one program read it and pass it on");
}

std::string AsIsSupervisor::reason_to_refuse(CallerId caller, const Body& body) const {
  if (agents_.count(caller) > 0) return "";
  if (std::holds_alternative<link::ReceiveMessage>(body))
    return "with 'all_processes', receive() is not available. Messages of the flight controller "
           "come to UDP port 14540";
  const auto* const read = std::get_if<link::ReadSensor>(&body);
  const auto& sensors = vehicle_->catalogue().sensors;
  if (read == nullptr || read->sensor >= sensors.size() || sensors[read->sensor].rate_hz > 0.0)
    return "";
  return "with 'all_processes', sensor '" + sensors[read->sensor].name +
         "', which measures on demand, cannot be read. Give it a rate (sensors in the scenario's "
         "profile)";
}

void AsIsSupervisor::answer(CallerId caller, std::uint64_t sequence, Body body) {
  auto reply = client::pass_on(*vehicle_, std::move(body));
  if (!reply) {
    callers_.send(caller, link::Refusal{link::Refusal::Reason::kRunEnded, reply.failure().message});
    check(reply.failure());
    return;
  }
  publish();
  reply->sequence = sequence;
  callers_.send(caller, *reply);
}

// In the order in which they asked. Those whose measurement is not there yet wait for it.
void AsIsSupervisor::answer_reads() {
  for (std::size_t i = 0; i < reads_.size() && !is_over_;) {
    link::ReadSensor now_or_never = reads_[i].what;
    now_or_never.only_if_available = true;
    auto reply = client::pass_on(*vehicle_, now_or_never);
    publish();
    if (reply && !reply->sample) {
      ++i;
      continue;
    }
    const Read read = reads_[i];
    reads_.erase(reads_.begin() + static_cast<std::ptrdiff_t>(i));
    if (reply) {
      reply->sequence = read.sequence;
      callers_.send(read.caller, *reply);
    } else {
      check(reply.failure());
    }
  }
}

void AsIsSupervisor::on_gone(CallerId caller) {
  lines_.erase(caller);
  unheard_.erase(caller);
  agents_.erase(caller);
  const auto is_of_caller = [caller](const auto& call) { return call.caller == caller; };
  std::erase_if(pulls_, is_of_caller);
  std::erase_if(reads_, is_of_caller);
  for (auto& [sensor, readers] : readers_) readers.all.erase(caller);
}

void AsIsSupervisor::tell(CallerId line, link::Reply event) {
  if (callers_.send(line, event))
    unheard_.insert(line);
  else
    on_gone(line);
}

void AsIsSupervisor::wake_overdue() {
  const ExecTime now = page_.glance();
  if (page_.first_deadline() > now) return;
  const Duration real = client::read_monotonic();
  for (const auto& [line, process] : std::map(lines_))
    if (page_.tell_overdue(process, now, real - kBetweenTellings, real))
      tell(line, reply_of(static_cast<std::uint64_t>(GroupEvent::kDue), now));
}

// --- the coordinator ----------------------------------------------------------------------------

/// False: the run is over, or cannot go on.
bool AsIsSupervisor::check(const Failure& failure) {
  if (failure.kind == Failure::Kind::kNothingYet || failure.kind == Failure::Kind::kInvalid)
    return true;
  if (failure.kind != Failure::Kind::kRunEnded) say_(failure.message);
  is_over_ = true;
  return false;
}

// Of one instant, in which no process of the program had the core.
void AsIsSupervisor::publish() {
  for (;;) {
    const Duration used = page_.used();
    const ExecTime now = vehicle_->now();
    if (page_.used() == used) return page_.publish(now, used, factor_);
  }
}

/// Whether anything came.
bool AsIsSupervisor::receive(Duration timeout) {
  const auto& sensors = vehicle_->catalogue().sensors;
  std::uint64_t wanted = 0;
  for (const auto& process : page_.processes())
    if (process.id > 0) wanted |= process.sensors;
  std::vector<std::string_view> names;
  for (std::size_t i = 0; i < sensors.size(); ++i)
    if ((i < 64 && (wanted >> i & 1) != 0) ||
        std::ranges::any_of(reads_, [i](const Read& read) { return read.what.sensor == i; }))
      names.emplace_back(sensors[i].name);
  const Duration used = page_.used();
  const auto received = vehicle_->receive_or_measure(timeout, names, 1);
  if (timeout > Duration(0)) tell_if_woken(used);
  publish();
  if (!received && !check(received.failure())) return false;
  if (received) deliver(*received);
  if (received && received->empty()) answer_reads();
  return received.ok();
}

void AsIsSupervisor::deliver(const std::vector<client::RadioMessage>& received) {
  const bool is_message = !received.empty();
  link::Reply event = reply_of(
      static_cast<std::uint64_t>(is_message ? GroupEvent::kMessage : GroupEvent::kMeasured),
      vehicle_->now());
  if (is_message) {
    const client::RadioMessage& message = received.front();
    event.message = {message.from, message.sent_at, message.arrived_at, message.bytes};
  }
  for (const auto& [line, process] : std::map(lines_))
    for (const auto& one : page_.processes())
      if (one.id == process && (is_message ? one.listens.load() : one.sensors != 0))
        tell(line, event);
}

// One by one: a measurement stays until its process has read it.
void AsIsSupervisor::pull() {
  pulled_at_ = page_.glance();
  is_pulling_ = true;
}

void AsIsSupervisor::pull_now_and_then() {
  if (is_fed() && page_.glance() - pulled_at_ >= kBetweenPulls) pull();
}

// While one computes, their CPU time grows: then there is no need to look closer.
bool AsIsSupervisor::are_all_waiting() {
  const ExecTime now = page_.glance();
  return std::exchange(glanced_, now) == now && threads_.are_all_waiting(page_);
}

// They all waited, and were told nothing: who computed meanwhile was woken from outside. What the
// kernel still accounts of those that have just begun to wait is less.
void AsIsSupervisor::tell_if_woken(Duration used) {
  const Duration more = page_.used() - used;
  if (more == Duration(0) || (more < kLeastWoken && threads_.are_all_waiting(page_))) return;
  if (++wakes_ != kWakes) return;
  doubt(
      "has a program that waited for something outside of its processes, such as a lock, another "
      "computer or a server: how long that takes depends on the simulation's speed. Start a server "
      "with the program; with --one-process, such waits are seen");
}

/// What makes the answer doubtful, in words without quotation marks.
void AsIsSupervisor::doubt(const std::string& what) {
  static_cast<void>(vehicle_->annotate("as_is", R"({"doubt": ")" + what + R"("})"));
}

/// Lets ET go on to what comes first.
bool AsIsSupervisor::lead() {
  const ExecTime first = page_.first_deadline(), now = vehicle_->now();
  if (first <= now) return false;
  receive(first == GroupPage::kNever ? kForEver : first - now);
  if (!is_over_) wake_overdue();
  pulled_at_ = page_.glance();
  return true;
}

void AsIsSupervisor::finish(int exit_code) {
  page_.forget_ended(computed_);
  client::Computed all = computed_;
  page_.add_present(all);
  static_cast<void>(vehicle_->finish(
      exit_code == 0, "the program ended with exit code " + std::to_string(exit_code),
      client::details_of(all)));
}

}  // namespace tether::supervisor
