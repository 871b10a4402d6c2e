#include "errors.h"
#include "handles.h"
#include "samples.h"

#include <memory>
#include <utility>

#include <tether/client/subscription.h>

using namespace tether::c_api;

struct tether_subscription {
  std::unique_ptr<tether::client::Subscription> subscription;
};

namespace {

/// Subscribes by `subscribe`, one function of target/client, with a callback that it understands.
template <class Subscribe, class Callback>
tether_status subscribe_by(Subscribe subscribe, tether_vehicle* vehicle, const char* sensor,
                           Callback callback, tether_subscription** out) {
  return guarded([&] {
    // Made first, so that nothing is undone when memory runs out.
    auto made = std::make_unique<tether_subscription>();
    auto subscription = subscribe(*vehicle->vehicle, sensor, std::move(callback));
    if (!subscription) return fail(subscription.failure());
    made->subscription = std::move(*subscription);
    *out = made.release();
    return tether_status{TETHER_OK};
  });
}

/// Clears *out; whether everything is there.
bool can_subscribe(const tether_vehicle* vehicle, const char* sensor, bool has_callback,
                   tether_subscription** out) {
  if (!are_given(out)) return false;
  *out = nullptr;
  if (!has_callback) fail(TETHER_INVALID, "the callback must not be NULL");
  return has_callback && are_given(vehicle, sensor);
}

}  // namespace

extern "C" {

tether_status tether_subscribe_camera(tether_vehicle* vehicle, const char* sensor,
                                      tether_on_image on_image, void* user,
                                      tether_subscription** out) noexcept {
  if (!can_subscribe(vehicle, sensor, on_image != nullptr, out)) return TETHER_INVALID;
  const auto show = [=](const tether::uav::CameraSample& sample) {
    const tether_image shown(&sample);
    on_image(&shown, user);
  };
  return subscribe_by(tether::client::subscribe_camera, vehicle, sensor, show, out);
}

tether_status tether_subscribe_imu(tether_vehicle* vehicle, const char* sensor,
                                   tether_on_imu on_sample, void* user,
                                   tether_subscription** out) noexcept {
  if (!can_subscribe(vehicle, sensor, on_sample != nullptr, out)) return TETHER_INVALID;
  const auto show = [=](const tether::uav::ImuSample& sample) {
    const tether_imu_sample shown = to_c(sample);
    on_sample(&shown, user);
  };
  return subscribe_by(tether::client::subscribe_imu, vehicle, sensor, show, out);
}

tether_status tether_subscribe_range(tether_vehicle* vehicle, const char* sensor,
                                     tether_on_range on_sample, void* user,
                                     tether_subscription** out) noexcept {
  if (!can_subscribe(vehicle, sensor, on_sample != nullptr, out)) return TETHER_INVALID;
  const auto show = [=](const tether::uav::RangeSample& sample) {
    const tether_range_sample shown = to_c(sample);
    on_sample(&shown, user);
  };
  return subscribe_by(tether::client::subscribe_range, vehicle, sensor, show, out);
}

tether_status tether_subscription_status(const tether_subscription* subscription) noexcept {
  if (!are_given(subscription)) return TETHER_INVALID;
  return guarded([&] {
    const auto ended = subscription->subscription->ended();
    return ended ? fail(*ended) : tether_status{TETHER_OK};
  });
}

void tether_unsubscribe(tether_subscription* subscription) noexcept {
  delete subscription;
}

}  // extern "C"
