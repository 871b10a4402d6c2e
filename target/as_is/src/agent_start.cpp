// How an agent begins, in the first process of a program, and in others.

#include "agent.h"
#include "beside_source.h"
#include "real.h"
#include "signals.h"

#include <cstdlib>
#include <string>
#include <string_view>
#include <utility>

#include <unistd.h>

#include <tether/computer/clock.h>

namespace tether::as_is {

std::string program_name() {
  char path[4096];
  const ssize_t size = ::readlink("/proc/self/exe", path, sizeof path - 1);
  const std::string whole(path, size > 0 ? static_cast<std::size_t>(size) : 0);
  return whole.substr(whole.rfind('/') + 1);
}

Agent::Agent(std::unique_ptr<GroupMember> group)
    : group_(std::move(group)),
      own_source_(client::make_group_source(group_->page(), 1.0, &group_->process())),
      source_(own_source_.get()),
      factor_(1.0),
      process_(::getpid()) {
  Unpaid::clock_stands_in_calls = false;
  Signals::count_unseen_in(group_->process().unseen);
}

void Agent::start_in_group() {
  if (auto member = GroupMember::of_environment())
    instance_.store(new Agent(std::move(member)), std::memory_order_release);
}

void Agent::leave() {
  const Inside inside;
  const Agent* const parent = instance_.exchange(nullptr);
  if (parent == nullptr) return;
  if (parent->is_stopped_)
    return instance_.store(new Agent(parent->clock_), std::memory_order_release);
  if (!parent->group_) return;
  if (auto member = GroupMember::of_child(*parent->group_))
    instance_.store(new Agent(std::move(member)), std::memory_order_release);
}

Agent::Agent(const client::Vehicle* clock)
    : own_source_(client::make_wall_source()),
      source_(own_source_.get()),
      factor_(1.0),
      process_(::getpid()),
      is_stopped_(true),
      clock_(clock) {
  const char* const text = std::getenv("TETHER_CLOCK");
  if (const auto known = computer::parse_clock(text == nullptr ? "wall" : text); known)
    factor_ = known->factor;
  if (clock_ == nullptr) clock_ = &vehicle();
}

Result<std::unique_ptr<client::Vehicle>> Agent::connect_to_exec() const {
  client::ConnectOptions options;
  const char* const socket = std::getenv("TETHER_EXEC");
  options.exec_socket = group_ ? group_->socket() : socket == nullptr ? "" : socket;
  options.sut_name = group_ ? client::kGroupAgent : program_name();
  return client::connect(std::move(options));
}

client::Vehicle& Agent::vehicle() {
  if (group_ || is_stopped_)
    std::call_once(connects_, [this] {
      auto vehicle = connect_to_exec();
      if (!vehicle) end(vehicle.failure());
      vehicle_ = std::move(*vehicle);
      add_sensors();
    });
  return *vehicle_;
}

void Agent::start() {
  const Inside inside;
  if (const char* kind = std::getenv("TETHER_AS_IS"); kind && std::string_view(kind) == "group")
    return start_in_group();
  auto options = client::options_from_environment();
  if (!options) return say(options.failure().message + "; the program runs by itself");
  if (!options->exec_socket.empty())
    return instance_.store(new Agent(nullptr), std::memory_order_release);
  options->sut_name = program_name();
  if (options->time) options->time = charge_beside_calls(std::move(options->time));
  client::TimeSource* const source = options->time.get();
  auto vehicle = client::connect(std::move(*options));
  if (!vehicle) {
    say(vehicle.failure().message);
    ::_exit(3);
  }
  auto* const agent = new Agent(std::move(*vehicle), *source);
  agent->process_ = ::getpid();
  instance_.store(agent, std::memory_order_release);
}

}  // namespace tether::as_is
