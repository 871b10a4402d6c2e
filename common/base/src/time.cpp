#include <cmath>
#include <limits>

#include <tether/base/time.h>

namespace tether {

namespace {
// 2^63 ns in seconds: the first double that no int64 of nanoseconds can hold.
constexpr double kLimitNs = 9223372036854775808.0;
}  // namespace

Duration duration_from_seconds(double seconds) {
  const double ns = std::round(seconds * 1e9);
  if (std::isnan(ns)) return Duration(0);
  if (ns >= kLimitNs) return Duration::max();
  if (ns < -kLimitNs) return Duration::min();
  return Duration(static_cast<std::int64_t>(ns));
}

bool is_representable_seconds(double seconds) {
  return std::isfinite(seconds) && std::abs(seconds) * 1e9 < kLimitNs;
}

}  // namespace tether
