#pragma once

#include <cstdint>
#include <memory>
#include <string_view>
#include <variant>
#include <vector>

#include <tether/base/random.h>
#include <tether/base/time.h>

/// When a sensor measures, and when its data is available (paper, Section IV and Fig. 8; DESIGN
/// section 2, "Sensor timing").
namespace tether::uav {

struct ConstantDelay {
  Duration value{0};
};
/// Normal, truncated at 0 by redrawing.
struct NormalDelay {
  Duration mean{0};
  Duration stddev{0};
};
/// One of the measured samples, all with the same probability. Not empty; none negative.
struct EmpiricalDelay {
  std::vector<Duration> samples;
};
using Delay = std::variant<ConstantDelay, NormalDelay, EmpiricalDelay>;

/// The delay of one measurement: a pure function of its key. Never negative.
Duration draw(const Delay& delay, const RandomKey& key);
/// The mean of the distribution as given (of the untruncated normal).
Duration mean(const Delay& delay);

struct OnDemandTiming {
  Delay delay;
};
struct PeriodicTiming {
  Duration period{0};  ///< > 0
  Duration phase{0};   ///< sampling instant of measurement 0; ≥ 0
  Delay delay;
};
using SensorTiming = std::variant<OnDemandTiming, PeriodicTiming>;

/// The instant at which periodic measurement k is sampled.
constexpr SimTime sampling_instant(const PeriodicTiming& timing, std::uint64_t index) {
  return SimTime(timing.phase + static_cast<std::int64_t>(index) * timing.period);
}

}  // namespace tether::uav
