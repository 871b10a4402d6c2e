#include <algorithm>
#include <cmath>

#include <tether/uav/sensor_timing.h>

namespace tether::uav {
namespace {

/// Of truncated jitter, half of the draws are valid or more.
constexpr int kMostJitterDraws = 1000;
constexpr std::int64_t kBillion = 1'000'000'000;

bool happens(double probability, RandomKey key, std::uint64_t index) {
  if (probability <= 0.0) return false;
  key.index = index;
  return KeyedRandom(key).uniform() < probability;
}

/// What a clock that gains `ppb` is ahead at `t`.
Duration gained(SimTime t, std::int64_t ppb) {
  const std::int64_t ns = to_ns(t);
  return Duration(ns / kBillion * ppb + ns % kBillion * ppb / kBillion);
}

}  // namespace

Driver::Driver(const DriverModel& model, std::optional<Duration> period, std::uint64_t seed,
               std::string_view uav, std::string_view sensor)
    : model_(model),
      jitter_key_{.seed = seed, .stream = random_stream(uav, sensor, "stamp jitter")},
      lost_key_{.seed = seed, .stream = random_stream(uav, sensor, "lost")},
      repeated_key_{.seed = seed, .stream = random_stream(uav, sensor, "repeated")} {
  if (period)
    most_jitter_ = Duration(
        static_cast<std::int64_t>(kMostJitter_periods * static_cast<double>(period->count())));
}

bool Driver::loses(std::uint64_t index) const {
  return happens(model_.lost_probability, lost_key_, index);
}

bool Driver::repeats(std::uint64_t index) const {
  return happens(model_.repeated_probability, repeated_key_, index);
}

// The first sample that arrives has nothing to repeat.
std::uint64_t Driver::content_of(std::uint64_t index) const {
  std::uint64_t content = index;
  while (content > 0 && (loses(content) || repeats(content))) --content;
  while (content < index && loses(content)) ++content;
  return content;
}

Duration Driver::jitter(std::uint64_t index) const {
  if (model_.stamp_jitter <= Duration(0)) return Duration(0);
  RandomKey key = jitter_key_;
  key.index = index;
  KeyedRandom random(key);
  for (int i = 0; i < kMostJitterDraws; ++i) {
    const Duration drawn(
        std::llround(static_cast<double>(model_.stamp_jitter.count()) * random.normal()));
    if (!most_jitter_ || std::chrono::abs(drawn) <= *most_jitter_) return drawn;
  }
  return Duration(0);
}

SimTime Driver::stamp(SimTime instant, std::uint64_t index) const {
  return std::max(SimTime{}, instant + model_.stamp_offset +
                                 gained(instant, model_.stamp_drift_ppb) + jitter(index));
}

}  // namespace tether::uav
