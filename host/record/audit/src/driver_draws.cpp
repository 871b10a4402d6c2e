#include "driver_draws.h"

#include <algorithm>
#include <cmath>

namespace tether::audit {
namespace {

// Of a profile: some samples arrive.
constexpr double kMostProbability = 0.99;
// Beyond any time; sums of such do not overflow.
constexpr Wide kMostInstant = Wide{1} << 90;

}  // namespace

DriverDraws::DriverDraws(const record::Header& header, const record::SensorInfo& sensor)
    : sensor_(sensor),
      model_(sensor.driver.value_or(record::DriverInfo{})),
      seed_(header.seed),
      is_synchronised_(header.policy != record::kFreeRunning) {}

bool DriverDraws::is_valid() const {
  const auto is_share = [](double p) { return p >= 0.0 && p <= kMostProbability; };
  return is_share(model_.lost_probability) && is_share(model_.repeated_probability);
}

RandomKey DriverDraws::key(const char* quantity, std::uint64_t index) const {
  return {seed_, random_stream(sensor_.uav, sensor_.name, quantity), index};
}

bool DriverDraws::happens(double probability, const char* quantity, std::uint64_t index) const {
  return is_valid() && probability > 0.0 &&
         KeyedRandom(key(quantity, index)).uniform() < probability;
}

bool DriverDraws::loses(std::uint64_t index) const {
  return happens(model_.lost_probability, "lost", index);
}

// In free running, samples are the state at the read. The first that arrives repeats nothing.
std::uint64_t DriverDraws::content_of(std::uint64_t index) const {
  if (!is_synchronised_) return index;
  std::uint64_t first_arrived = index;
  for (std::uint64_t k = index;; --k) {
    if (!loses(k)) {
      if (!happens(model_.repeated_probability, "repeated", k)) return k;
      first_arrived = k;
    }
    if (k == 0) return first_arrived;
  }
}

Wide DriverDraws::stamp(Wide instant, std::uint64_t index) const {
  constexpr int kMostDraws = 1000;
  constexpr double kMostJitter_periods = 0.4;
  const bool is_limited = is_synchronised_ && sensor_.periodic;
  const auto limit =
      static_cast<std::int64_t>(kMostJitter_periods * static_cast<double>(sensor_.period.count()));
  std::int64_t jitter_ns = 0;
  KeyedRandom random(key("stamp jitter", index));
  for (int i = 0; i < kMostDraws && model_.stamp_jitter > Duration(0); ++i) {
    const double drawn_ns = static_cast<double>(model_.stamp_jitter.count()) * random.normal();
    if (!(std::abs(drawn_ns) < 0x1p62)) continue;
    if (is_limited && std::abs(std::llround(drawn_ns)) > limit) continue;
    jitter_ns = std::llround(drawn_ns);
    break;
  }
  instant = std::clamp(instant, -kMostInstant, kMostInstant);
  const Wide gained = instant * model_.stamp_drift_ppb / 1'000'000'000;
  return std::max<Wide>(0, instant + wide(model_.stamp_offset) + gained + jitter_ns);
}

}  // namespace tether::audit
