#include "agent.h"

#include "real.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>

#include <unistd.h>

#include <tether/link/messages.h>

namespace tether::as_is {
namespace {

// How long a thread waits in real time before it looks again whether all others wait.
constexpr Duration kSlice = std::chrono::microseconds(500);
// Of a wait without a deadline; then it begins again.
constexpr Duration kForEver = std::chrono::hours(1);

void say(const std::string& line) {
  std::fprintf(stderr, "tether: %s\n", line.c_str());
}

/// The program's own name: the last part of its path.
std::string program_name() {
  char path[4096];
  const ssize_t size = ::readlink("/proc/self/exe", path, sizeof path - 1);
  const std::string whole(path, size > 0 ? static_cast<std::size_t>(size) : 0);
  return whole.substr(whole.rfind('/') + 1);
}

}  // namespace

thread_local int Inside::depth_ = 0;
std::atomic<Agent*> Agent::instance_ = nullptr;

void Agent::start() {
  const Inside inside;
  auto options = client::options_from_environment();
  if (!options) return say(options.failure().message + "; the program runs by itself");
  options->sut_name = program_name();
  auto vehicle = client::connect(std::move(*options));
  if (!vehicle) {
    say(vehicle.failure().message);
    ::_exit(3);
  }
  instance_.store(new Agent(std::move(*vehicle)), std::memory_order_release);
}

// The run is over, or cannot go on: so is the program. It says nothing that the coordinator does
// not know.
void Agent::end(const Failure& failure) {
  if (failure.kind != Failure::Kind::kRunEnded) say(failure.message);
  instance_.store(nullptr);
  TETHER_REAL(_exit)(failure.kind == Failure::Kind::kRunEnded ? 0 : 3);
  std::abort();
}

bool Agent::receive_until(std::optional<ExecTime> until) {
  const Duration timeout = until ? std::max(Duration(0), *until - now()) : kForEver;
  auto message = vehicle_->receive(timeout);
  if (message) {
    if (message->from == link::kAutopilot) port_.deliver(message->bytes);
    return true;
  }
  if (message.failure().kind != Failure::Kind::kNothingYet) end(message.failure());
  return false;
}

void Agent::take_arrived() {
  const std::lock_guard leading(leading_);
  while (receive_until(now())) {
  }
}

bool Agent::send(std::span<const std::uint8_t> bytes) {
  const std::lock_guard leading(leading_);
  const Status sent = vehicle_->send(link::kAutopilot, bytes);
  if (sent) return true;
  if (sent.failure().kind != Failure::Kind::kInvalid) end(sent.failure());
  return false;
}

// Whether ET went on, or a message came. Nobody may be past its deadline: that one runs first.
bool Agent::lead() {
  const std::unique_lock leading(leading_, std::try_to_lock);
  if (!leading || !threads_.are_others_waiting()) return false;
  std::optional<ExecTime> earliest;
  {
    const std::lock_guard lock(waits_mutex_);
    for (const auto& deadline : waits_)
      if (deadline) earliest = std::min(earliest.value_or(*deadline), *deadline);
  }
  if (earliest && *earliest <= now()) return false;
  receive_until(earliest);
  return true;
}

bool Agent::wait(std::optional<ExecTime> deadline, const std::function<bool()>& is_ready,
                 const std::function<void(Duration)>& block) {
  const auto own = [&] {
    const std::lock_guard lock(waits_mutex_);
    return waits_.insert(waits_.end(), deadline);
  }();
  bool ready = false;
  while (!(ready = is_ready()) && !(deadline && now() >= *deadline))
    if (!lead()) block(kSlice);
  const std::lock_guard lock(waits_mutex_);
  waits_.erase(own);
  return ready;
}

void Agent::sleep_until(ExecTime deadline) {
  wait(
      deadline, [] { return false; },
      [](Duration slice) {
        const timespec time{0, static_cast<long>(slice.count())};
        TETHER_REAL(nanosleep)(&time, nullptr);
      });
}

void Agent::finish(int exit_code) {
  if (instance_.exchange(nullptr) == nullptr) return;
  const std::lock_guard leading(leading_);
  static_cast<void>(vehicle_->finish(
      exit_code == 0, "the program ended with exit code " + std::to_string(exit_code), "{}"));
}

}  // namespace tether::as_is
