#include "errors.h"
#include "handles.h"
#include "samples.h"

#include <memory>
#include <utility>

#include <tether/client/vehicle.h>

using namespace tether::c_api;

struct tether_subscription {
  std::unique_ptr<tether::client::Subscription> subscription;
};

namespace {

/// Clears *out; whether everything is there.
bool can_subscribe(const tether_vehicle* vehicle, const char* sensor, bool has_callback,
                   tether_subscription** out) {
  if (!are_given(out)) return false;
  *out = nullptr;
  if (!has_callback) fail(TETHER_INVALID, "the callback must not be NULL");
  return has_callback && are_given(vehicle, sensor);
}

/// @param show  the sample to the callback of C
template <class Sample, class Show>
tether_status subscribe(tether_vehicle* vehicle, const char* sensor, bool has_callback, Show show,
                        tether_subscription** out) {
  if (!can_subscribe(vehicle, sensor, has_callback, out)) return TETHER_INVALID;
  return guarded([&] {
    // Made first, so that nothing is undone when memory runs out.
    auto made = std::make_unique<tether_subscription>();
    auto subscription = tether::client::subscribe<Sample>(*vehicle->vehicle, sensor, show);
    if (!subscription) return fail(subscription.failure());
    made->subscription = std::move(*subscription);
    *out = made.release();
    return tether_status{TETHER_OK};
  });
}

/// For samples that are a plain struct.
template <class Sample, class Callback>
tether_status subscribe_struct(tether_vehicle* vehicle, const char* sensor, Callback callback,
                               void* user, tether_subscription** out) {
  const auto show = [=](const Sample& sample) {
    const auto shown = tether::c_api::to_c(sample);
    callback(&shown, user);
  };
  return subscribe<Sample>(vehicle, sensor, callback != nullptr, show, out);
}

}  // namespace

extern "C" {

tether_status tether_subscribe_camera(tether_vehicle* vehicle, const char* sensor,
                                      tether_on_image on_image, void* user,
                                      tether_subscription** out) noexcept {
  const auto show = [=](const tether::uav::CameraSample& sample) {
    const tether_image shown(&sample);
    on_image(&shown, user);
  };
  return subscribe<tether::uav::CameraSample>(vehicle, sensor, on_image != nullptr, show, out);
}

#define TETHER_SUBSCRIBE(kind, Sample, size)                                             \
  tether_status tether_subscribe_##kind(tether_vehicle* vehicle, const char* sensor,     \
                                        tether_on_##kind on_sample, void* user,          \
                                        tether_subscription** out) noexcept {            \
    return subscribe_struct<tether::uav::Sample>(vehicle, sensor, on_sample, user, out); \
  }
TETHER_SAMPLES(TETHER_SUBSCRIBE)
#undef TETHER_SUBSCRIBE

tether_status tether_subscribe_scan(tether_vehicle* vehicle, const char* sensor,
                                    tether_on_scan on_scan, void* user,
                                    tether_subscription** out) noexcept {
  return subscribe_struct<tether::uav::ScanSample>(vehicle, sensor, on_scan, user, out);
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
