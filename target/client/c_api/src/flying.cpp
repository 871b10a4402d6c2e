#include "errors.h"
#include "handles.h"

#include <string_view>

using namespace tether::c_api;

extern "C" {

tether_status tether_command_velocity(tether_vehicle* vehicle, double ahead_m_s, double left_m_s,
                                      double up_m_s, double yaw_rate_rad_s) noexcept {
  if (!are_given(vehicle)) return TETHER_INVALID;
  return guarded([&] {
    return status_of(vehicle->vehicle->command_velocity(
        {.velocity_H_m_s = {ahead_m_s, left_m_s, up_m_s}, .yaw_rate_rad_s = yaw_rate_rad_s}));
  });
}

int64_t tether_now(const tether_vehicle* vehicle) noexcept {
  return are_given(vehicle) ? tether::to_ns(vehicle->vehicle->now()) : 0;
}

tether_status tether_sleep_for(tether_vehicle* vehicle, int64_t duration_ns) noexcept {
  if (!are_given(vehicle)) return TETHER_INVALID;
  return guarded(
      [&] { return status_of(vehicle->vehicle->sleep_for(tether::Duration(duration_ns))); });
}

tether_status tether_sleep_until(tether_vehicle* vehicle, int64_t et_ns) noexcept {
  if (!are_given(vehicle)) return TETHER_INVALID;
  return guarded([&] {
    return status_of(vehicle->vehicle->sleep_until(tether::from_ns<tether::ExecTime>(et_ns)));
  });
}

tether_status tether_annotate(tether_vehicle* vehicle, const char* topic,
                              const char* json) noexcept {
  if (!are_given(vehicle, topic, json)) return TETHER_INVALID;
  return guarded([&] { return status_of(vehicle->vehicle->annotate(topic, json)); });
}

tether_status tether_stage_begin(tether_vehicle* vehicle, const char* stage) noexcept {
  if (!are_given(vehicle, stage)) return TETHER_INVALID;
  return guarded([&] { return status_of(vehicle->vehicle->begin_stage(stage)); });
}

tether_status tether_stage_end(tether_vehicle* vehicle) noexcept {
  if (!are_given(vehicle)) return TETHER_INVALID;
  return guarded([&] { return status_of(vehicle->vehicle->end_stage()); });
}

tether_status tether_finish(tether_vehicle* vehicle, int32_t reached_goal, const char* outcome,
                            const char* details_json) noexcept {
  if (!are_given(vehicle, outcome, details_json)) return TETHER_INVALID;
  return guarded([&] {
    return status_of(vehicle->vehicle->finish(reached_goal != 0, outcome, details_json));
  });
}

}  // extern "C"
