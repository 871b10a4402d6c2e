#include "errors.h"
#include "handles.h"

#include <cerrno>
#include <string>
#include <utility>

using tether::c_api::are_given;
using tether::c_api::fail;
using tether::c_api::guarded;

namespace {

using tether::Failure;
using tether::Result;
using tether::client::ConnectOptions;

/// What the options start from.
Result<ConnectOptions> base_of(const tether_options& options) {
  if (options.of_environment) return tether::client::options_from_environment();
  const auto missing = [](const char* what) {
    return Failure{Failure::Kind::kInvalid, std::string("the options have no ") + what};
  };
  if (!options.address) return missing("address");
  if (!options.token || options.token->empty()) return missing("token");
  return ConnectOptions{};
}

template <class T>
void take(const std::optional<T>& set, T& value) {
  if (set) value = *set;
}

Result<ConnectOptions> to_connect_options(const tether_options& options) {
  auto result = base_of(options);
  if (!result) return result;
  take(options.address, result->address);
  take(options.token, result->token);
  take(options.uav, result->uav);
  result->sut_name = options.sut_name.value_or(program_invocation_short_name);
  take(options.connect_timeout, result->connect_timeout);
  take(options.welcome_timeout, result->welcome_timeout);
  if (!options.clock) return result;
  auto time = tether::client::parse_time_source(*options.clock);
  if (!time) return time.failure();
  result->time = std::move(*time);
  return result;
}

tether_status connect_with(const tether_options& options, tether_vehicle** out) {
  return guarded([&] {
    auto connect_options = to_connect_options(options);
    if (!connect_options) return fail(connect_options.failure());
    auto vehicle = tether::client::connect(std::move(*connect_options));
    if (!vehicle) return fail(vehicle.failure());
    *out = new tether_vehicle(std::move(*vehicle));
    return tether_status{TETHER_OK};
  });
}

}  // namespace

extern "C" {

tether_status tether_connect(const tether_options* options, tether_vehicle** out) noexcept {
  if (!are_given(out)) return TETHER_INVALID;
  *out = nullptr;
  const tether_options environment(true);
  return connect_with(options == nullptr ? environment : *options, out);
}

void tether_disconnect(tether_vehicle* vehicle) noexcept {
  delete vehicle;
}

int32_t tether_is_concurrent(const tether_vehicle* vehicle) noexcept {
  return are_given(vehicle) && vehicle->vehicle->is_concurrent() ? 1 : 0;
}

}  // extern "C"
