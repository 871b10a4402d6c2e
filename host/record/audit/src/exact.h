#pragma once

#include <string>

#include <tether/base/time.h>

/// Arithmetic on times that cannot overflow, whatever the record contains.
namespace tether::audit {

__extension__ using Wide = __int128;  ///< ns

template <class Clock>
Wide wide(std::chrono::time_point<Clock, Duration> t) {
  return t.time_since_epoch().count();
}
inline Wide wide(Duration d) {
  return d.count();
}

/// A duration on a clock that runs `factor` times as fast, rounded up.
inline Wide scaled(Wide duration, double factor) {
  return factor == 1.0 ? duration
                       : static_cast<Wide>(static_cast<long double>(duration) *
                                           static_cast<long double>(factor)) +
                             1;
}

/// Decimal digits and the unit of a duration or a time.
inline std::string ns(Wide value) {
  std::string digits;
  const bool negative = value < 0;
  do {
    const int digit = static_cast<int>(value % 10);
    digits.insert(digits.begin(), static_cast<char>('0' + (negative ? -digit : digit)));
    value /= 10;
  } while (value != 0);
  return (negative ? "-" : "") + digits + " ns";
}

template <class Time>
requires requires(Time time) {
  wide(time);
}
std::string ns(Time time) {
  return ns(wide(time));
}

/// Step boundaries k·step, for any sign of the time. @pre step > 0.
class Boundaries {
 public:
  explicit Boundaries(Duration step) : step_(wide(step)) {}
  Wide step() const { return step_; }
  Wide at_or_before(Wide t) const {
    const Wide rest = t % step_;
    return t - (rest < 0 ? rest + step_ : rest);
  }
  Wide at_or_after(Wide t) const { return -at_or_before(-t); }
  bool contain(Wide t) const { return t % step_ == 0; }

 private:
  Wide step_;
};

}  // namespace tether::audit
