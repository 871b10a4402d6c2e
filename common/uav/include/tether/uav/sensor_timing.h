#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>
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
/// The least and the greatest delay that can be drawn.
std::pair<Duration, Duration> bounds(const Delay& delay);
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

/// How the driver of a sensor stamps and delivers its samples. By default each sample is delivered
/// once, with the instant at which it was sampled.
struct DriverModel {
  Duration stamp_offset{0};
  Duration stamp_jitter{0};           ///< standard deviation
  int stamp_drift_ppb = 0;            ///< what the clock of the stamps gains
  double lost_probability = 0.0;      ///< of each sample; [0, 1)
  double repeated_probability = 0.0;  ///< of each sample; [0, 1)
  friend bool operator==(const DriverModel&, const DriverModel&) = default;
};

/// What the driver does with each sample (DESIGN section 2, "Stamps, lost and repeated samples"):
/// pure functions of the seed, the UAV, the sensor and the sample's index.
class Driver {
 public:
  /// The jitter of a periodic sensor is drawn again beyond this share of its period. Clocks that
  /// drift by up to 10 % then still give later samples later stamps.
  static constexpr double kMostJitter_periods = 0.4;

  Driver() = default;
  /// @pre the period is that of a periodic sensor; with none, the jitter has no limit.
  Driver(const DriverModel& model, std::optional<Duration> period, std::uint64_t seed,
         std::string_view uav, std::string_view sensor);

  /// The driver stamps the samples: they are not as sampled.
  bool is_modelled() const { return model_ != DriverModel{}; }
  /// Sample `index` never arrives.
  bool loses(std::uint64_t index) const;
  /// The sample whose content is delivered as sample `index`: itself, or where that is repeated the
  /// newest before it that arrived with content of its own. Does not fall with the index.
  std::uint64_t content_of(std::uint64_t index) const;
  /// The stamp of sample `index` of this instant; not before 0.
  SimTime stamp(SimTime instant, std::uint64_t index) const;

 private:
  bool repeats(std::uint64_t index) const;
  Duration jitter(std::uint64_t index) const;

  DriverModel model_;
  std::optional<Duration> most_jitter_{};
  RandomKey jitter_key_{};
  RandomKey lost_key_{};
  RandomKey repeated_key_{};
};

/// The instant at which periodic measurement k is sampled.
constexpr SimTime sampling_instant(const PeriodicTiming& timing, std::uint64_t index) {
  return SimTime(timing.phase + static_cast<std::int64_t>(index) * timing.period);
}

}  // namespace tether::uav
