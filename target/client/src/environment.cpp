#include "clocks/counted_source.h"

#include <cstdlib>
#include <optional>
#include <string>
#include <utility>

#include <tether/client/simulated_vehicle.h>

namespace tether::client {
namespace {

std::optional<std::string> variable(const char* name) {
  const char* const value = std::getenv(name);
  if (value == nullptr) return std::nullopt;
  return std::string(value);
}

Failure not_set(const std::string& name, const std::string& meaning) {
  return {Failure::Kind::kInvalid, name +
                                       " is not set. Start this program with `tether run`, or "
                                       "set the variable to " +
                                       meaning};
}

}  // namespace

Result<std::unique_ptr<TimeSource>> parse_time_source(const std::string& text) {
  const auto clock = computer::parse_clock(text);
  if (!clock) return clock.failure();
  switch (clock->kind) {
    case computer::ClockKind::kWall:
      return make_wall_source(clock->factor);
    case computer::ClockKind::kCpu:
      return make_cpu_source(clock->factor);
    case computer::ClockKind::kScripted:
      return make_scripted_source(clock->computing);
    case computer::ClockKind::kCounted:
      return make_counted_source(variable("TETHER_COUNTS").value_or(""));
    case computer::ClockKind::kReplayed:
      return make_replayed_source();
    case computer::ClockKind::kUnstamped:
      break;
  }
  return Failure{Failure::Kind::kInvalid,
                 "'unstamped' is for clients that do not stamp their requests; this library "
                 "always does. Use another clock in the condition"};
}

Result<ConnectOptions> options_from_environment() {
  ConnectOptions options;
  if (const auto exec_socket = variable("TETHER_EXEC"); exec_socket && !exec_socket->empty()) {
    options.exec_socket = *exec_socket;
    return options;
  }
  const auto address_text = variable("TETHER_ADDRESS");
  if (!address_text) return not_set("TETHER_ADDRESS", "the coordinator's host:port");
  const auto address = link::parse_address(*address_text);
  if (!address) {
    return Failure{Failure::Kind::kInvalid, "TETHER_ADDRESS: " + address.failure().message};
  }
  options.address = *address;

  const auto token = variable("TETHER_TOKEN");
  if (!token || token->empty()) {
    return not_set("TETHER_TOKEN", "the token that the coordinator prints");
  }
  options.token = *token;
  options.uav = variable("TETHER_UAV").value_or("");

  auto time = parse_time_source(variable("TETHER_CLOCK").value_or("wall"));
  if (!time) return Failure{time.failure().kind, "TETHER_CLOCK: " + time.failure().message};
  options.time = std::move(*time);
  return options;
}

}  // namespace tether::client
