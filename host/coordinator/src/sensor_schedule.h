#pragma once

#include <cstdint>
#include <optional>
#include <variant>

#include <tether/base/time.h>
#include <tether/uav/sensor_timing.h>

namespace tether::coordinator {

/// Which measurement a read gets, and when.
struct Measurement {
  std::uint64_t index = 0;
  SimTime sampled_at;
  SimTime available_at;  ///< ≥ sampled_at
  friend bool operator==(const Measurement&, const Measurement&) = default;
};

/// One sensor's timing model at work (DESIGN section 2, "Sensor timing"; paper, Fig. 8). Delays are
/// keyed by the measurement's index, so what a read gets depends on its time and on what was read
/// before, and on nothing else.
class SensorSchedule {
 public:
  SensorSchedule(uav::SensorTiming timing, std::uint64_t seed, std::uint64_t stream);

  /// The measurement that a read at `t` gets. Periodic: the newest that is available at t and was
  /// not yet read (with `latest`: read or not), else the one available first after t. On demand:
  /// sampled at t.
  Measurement choose(SimTime t, bool latest) const;
  /// The same in free running (DESIGN section 2, rule 8): the state of the moment, without delay.
  /// Periodic: one reading per period, so that a read whose period's measurement was already read
  /// (and is not asked for again with `latest`) waits for the next sampling instant.
  Measurement choose_untied(SimTime t, bool latest) const;
  /// What a read at `t` gets that does not wait; none where nothing is there. @pre periodic.
  std::optional<Measurement> choose_available(SimTime t, bool latest) const;
  /// The same in free running.
  std::optional<Measurement> choose_available_untied(SimTime t, bool latest) const;
  /// It was read.
  void mark_read(const Measurement& measurement);

  bool is_periodic() const { return std::holds_alternative<uav::PeriodicTiming>(timing_); }
  /// Periodic: when measurement `index` is sampled. None for a sensor on demand.
  std::optional<SimTime> sampling_instant(std::uint64_t index) const;
  /// Periodic: no read at `t` or later gets a measurement before this one.
  std::uint64_t first_readable(SimTime t) const;

 private:
  Measurement periodic(const uav::PeriodicTiming& timing, std::uint64_t index) const;
  static std::optional<std::uint64_t> newest_sampled(const uav::PeriodicTiming& timing, SimTime t);
  std::optional<Measurement> newest_available(const uav::PeriodicTiming& timing, SimTime t,
                                              std::uint64_t first) const;
  Measurement next_available(const uav::PeriodicTiming& timing, std::uint64_t first) const;

  uav::SensorTiming timing_;
  std::uint64_t seed_;
  std::uint64_t stream_;
  std::uint64_t unread_ = 0;  ///< least index that was not passed over by a read
};

}  // namespace tether::coordinator
