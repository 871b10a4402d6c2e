#include "errors.h"
#include "handles.h"

#include <utility>

using tether::c_api::are_given;
using tether::c_api::fail;
using tether::c_api::guarded;

namespace {

tether::Result<tether::client::ConnectOptions> to_connect_options(const tether_options& options) {
  using tether::Failure;
  if (!options.address) return Failure{Failure::Kind::kInvalid, "the options have no address"};
  if (options.token.empty()) return Failure{Failure::Kind::kInvalid, "the options have no token"};
  auto time = tether::client::parse_time_source(options.clock);
  if (!time) return time.failure();
  tether::client::ConnectOptions result;
  result.address = *options.address;
  result.token = options.token;
  result.sut_name = options.sut_name;
  result.uav = options.uav;
  result.time = std::move(*time);
  result.connect_timeout = options.connect_timeout;
  result.welcome_timeout = options.welcome_timeout;
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
  if (options != nullptr) return connect_with(*options, out);
  tether_options* found = nullptr;
  if (const tether_status status = tether_options_from_environment(&found); status != TETHER_OK)
    return status;
  const tether_status status = connect_with(*found, out);
  tether_options_free(found);
  return status;
}

void tether_disconnect(tether_vehicle* vehicle) noexcept {
  delete vehicle;
}

int32_t tether_is_concurrent(const tether_vehicle* vehicle) noexcept {
  return are_given(vehicle) && vehicle->vehicle->is_concurrent() ? 1 : 0;
}

}  // extern "C"
