#include "clocks/counted_source.h"

#include <cstdlib>
#include <locale>
#include <optional>
#include <sstream>
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

/// A decimal number that is all of the text, within the bounds; whatever the locale.
std::optional<double> parse_number(const std::string& text, double least, double most) {
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  double value = 0.0;
  if (!(stream >> value) || stream.peek() != std::istringstream::traits_type::eof()) return {};
  if (!(value >= least && value <= most)) return {};
  return value;
}

/// What follows `prefix` in `text`, if it begins so.
std::optional<std::string> after(const std::string& text, const std::string& prefix) {
  if (text.rfind(prefix, 0) != 0) return std::nullopt;
  return text.substr(prefix.size());
}

/// Null: not a clock.
std::unique_ptr<TimeSource> make_source(const std::string& text) {
  if (text == "wall") return make_wall_source();
  if (text == "cpu") return make_cpu_source(1.0);
  if (text == "replayed") return make_replayed_source();
  if (const auto factor = after(text, "wall*")) {
    const auto value = parse_number(*factor, 1e-6, 1e6);
    return value ? make_wall_source(*value) : nullptr;
  }
  if (const auto factor = after(text, "cpu*")) {
    const auto value = parse_number(*factor, 1e-6, 1e6);
    return value ? make_cpu_source(*value) : nullptr;
  }
  if (const auto step_ms = after(text, "scripted*")) {
    const auto value = parse_number(*step_ms, 1e-6, 1e6);
    return value ? make_scripted_source(duration_from_seconds(*value * 1e-3)) : nullptr;
  }
  return nullptr;
}

}  // namespace

Result<std::unique_ptr<TimeSource>> parse_time_source(const std::string& text) {
  if (text == "counted") return make_counted_source(variable("TETHER_COUNTS").value_or(""));
  if (auto source = make_source(text)) return source;
  if (text == "unstamped")
    return Failure{Failure::Kind::kInvalid,
                   "'unstamped' is for clients that do not stamp their requests; this library "
                   "always does. Use another clock in the condition"};
  return Failure{
      Failure::Kind::kInvalid,
      "'" + text +
          "' is not a clock. Allowed: wall, cpu, wall*FACTOR or cpu*FACTOR (cpu*4: a target "
          "that is four times slower; 1e-6 to 1e6), counted, replayed, scripted*MILLISECONDS"};
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
