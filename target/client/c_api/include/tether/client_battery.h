#pragma once

#include <tether/client.h>

/// @cond
#ifdef __cplusplus
extern "C" {
#endif
/// @endcond

/// @defgroup c_battery Battery
/// @ingroup c_api
/// What is left in the UAV's battery. A simulated UAV has a battery if its scenario gives it an
/// energy file.
/// @{

/// The battery at one instant. At the present current, it lasts for another
/// `charge * capacity_c / current_a` seconds, if it may be emptied. May grow.
typedef struct tether_battery_sample {
  int64_t sampled_at_ns;  ///< ST [ns]
  double voltage_v;       ///< at the terminals, under load [V]
  double current_a;       ///< drawn from it [A]
  double charge;          ///< what is left, as a share of the capacity; 0 to 1
  double capacity_c;      ///< charge of the full battery [C], which is [A s]
} tether_battery_sample;

/// Reads the battery. An @ref interaction that returns at the same ET.
/// @param vehicle  the UAV  @param[out] out  the battery now  @param size  sizeof *out
/// @return TETHER_OK or an @ref interaction error; TETHER_INVALID, without an interaction, if the
///   UAV has no battery
tether_status tether_read_battery(tether_vehicle* vehicle, tether_battery_sample* out,
                                  size_t size) TETHER_NOEXCEPT;

/// @}

#ifdef __cplusplus
}
#endif
