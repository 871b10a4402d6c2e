#include <algorithm>
#include <cmath>

#include <tether/uav/sensor_timing.h>

namespace tether::uav {
namespace {

/// Enough for any sensible distribution (half of the draws are valid at mean 0); with a mean far
/// below 0 the loop ends here.
constexpr int kMaxRedraws = 1000;
/// 292 years: keeps the rounding below within int64.
constexpr double kMaxDelay_ns = 9.2e18;

Duration draw_from(const ConstantDelay& delay, const RandomKey&) {
  return std::max(delay.value, Duration::zero());
}

Duration draw_from(const NormalDelay& delay, const RandomKey& key) {
  KeyedRandom random(key);
  const auto mean_ns = static_cast<double>(delay.mean.count());
  const auto stddev_ns = static_cast<double>(delay.stddev.count());
  for (int i = 0; i < kMaxRedraws; ++i) {
    const double value_ns = mean_ns + stddev_ns * random.normal();
    if (value_ns >= 0.0) {
      return Duration(std::llround(std::min(value_ns, kMaxDelay_ns)));
    }
  }
  return Duration::zero();
}

Duration draw_from(const EmpiricalDelay& delay, const RandomKey& key) {
  if (delay.samples.empty()) {
    return Duration::zero();
  }
  KeyedRandom random(key);
  const auto count = static_cast<double>(delay.samples.size());
  const auto index = static_cast<std::size_t>(random.uniform() * count);
  return std::max(delay.samples[std::min(index, delay.samples.size() - 1)], Duration::zero());
}

Duration mean_of(const ConstantDelay& delay) {
  return delay.value;
}
Duration mean_of(const NormalDelay& delay) {
  return delay.mean;
}
Duration mean_of(const EmpiricalDelay& delay) {
  if (delay.samples.empty()) {
    return Duration::zero();
  }
  double sum_ns = 0.0;
  for (const Duration sample : delay.samples) {
    sum_ns += static_cast<double>(sample.count());
  }
  return Duration(std::llround(sum_ns / static_cast<double>(delay.samples.size())));
}

}  // namespace

Duration draw(const Delay& delay, const RandomKey& key) {
  return std::visit([&key](const auto& d) { return draw_from(d, key); }, delay);
}

std::pair<Duration, Duration> bounds(const Delay& delay) {
  if (const auto* constant = std::get_if<ConstantDelay>(&delay))
    return {constant->value, constant->value};
  if (const auto* empirical = std::get_if<EmpiricalDelay>(&delay)) {
    const auto [least, greatest] = std::ranges::minmax_element(empirical->samples);
    return {*least, *greatest};
  }
  return {Duration(0), Duration::max()};
}

Duration mean(const Delay& delay) {
  return std::visit([](const auto& d) { return mean_of(d); }, delay);
}

}  // namespace tether::uav
