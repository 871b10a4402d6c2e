#pragma once

#include <cstdint>
#include <optional>
#include <variant>

#include <tether/base/time.h>
#include <tether/uav/sensor_timing.h>

namespace tether::coordinator {

/// The measurement that a read returns, and its times. `sampled_at` is when its content was really
/// sampled.
struct Measurement {
  std::uint64_t index = 0;
  SimTime sampled_at;
  SimTime available_at;            ///< ≥ sampled_at
  std::uint64_t repeats = 0;       ///< its content is that of the measurement so many before
  std::optional<SimTime> stamp{};  ///< that the SUT sees; none: `sampled_at` on the grid

  std::uint64_t content() const { return index - repeats; }
  friend bool operator==(const Measurement&, const Measurement&) = default;
};

/// Applies the timing model of one sensor (DESIGN section 2, "Sensor timing"; paper, Fig. 8).
/// Delays are keyed by the measurement's index. Therefore the result of a read depends only on its
/// time and on the earlier reads.
class SensorSchedule {
 public:
  SensorSchedule(const uav::SensorTiming& timing, std::uint64_t seed, std::uint64_t stream,
                 uav::Driver driver = {});
  /// The same in free running (DESIGN section 2, rule 8): measurements are the state at the read,
  /// without delay, and none repeats an earlier one. Periodic: one measurement per period, like a
  /// topic. @pre the driver's jitter has no limit.
  static SensorSchedule in_free_running(const uav::SensorTiming& timing, uav::Driver driver = {});

  /// From a read at `t` on, the newest `queue` measurements that were delivered wait to be read.
  /// When there are more than before, what had no place until `t` is gone.
  void set_queue(std::uint32_t queue, SimTime t);

  /// The measurement for a read at `t`. Periodic: the newest that is available at `t` and not yet
  /// read (with `latest`: read or not), else the first that is available after `t`. From a queue:
  /// the oldest in it that was not yet read, in the order in which they were sampled. On demand:
  /// sampled at `t`.
  Measurement choose(SimTime t, bool latest) const;
  /// The measurement for a read at `t` that does not wait; none if none is available. @pre
  /// periodic.
  std::optional<Measurement> choose_available(SimTime t, bool latest) const;
  bool is_read(std::uint64_t index) const { return index < unread_; }
  /// How many unread measurements before this one had no place in a queue of that depth. In free
  /// running, where nothing waits: how many it would have had.
  std::uint64_t unqueued(const Measurement& measurement, std::uint32_t queue) const;
  /// Marks it as read.
  void mark_read(const Measurement& measurement);
  /// The measurement whose content is delivered as measurement `index`.
  std::uint64_t content_of(std::uint64_t index) const { return driver_.content_of(index); }

  bool is_periodic() const { return !std::holds_alternative<uav::OnDemandTiming>(timing_); }
  /// When measurement `index` is sampled; none if that is at a read.
  std::optional<SimTime> sampling_instant(std::uint64_t index) const;
  /// The first measurement whose content a read at `t` or later can return.
  std::uint64_t first_readable(SimTime t) const;

 private:
  /// Of a periodic sensor in free running.
  struct Topic {
    uav::PeriodicTiming timing;
  };
  Measurement periodic(const uav::PeriodicTiming& timing, std::uint64_t index) const;
  static std::optional<std::uint64_t> newest_sampled(const uav::PeriodicTiming& timing, SimTime t);
  std::optional<Measurement> newest_available(const uav::PeriodicTiming& timing, SimTime t,
                                              std::uint64_t first) const;
  Measurement next_available(const uav::PeriodicTiming& timing, std::uint64_t first) const;
  /// The first measurement from `index` on that arrives.
  std::uint64_t next_arriving(std::uint64_t index) const;
  /// The newest measurement from `first` to before `end` that arrives.
  std::optional<std::uint64_t> newest_arriving(std::uint64_t first, std::uint64_t end) const;
  Measurement stamped(Measurement measurement, SimTime instant) const;

  std::variant<uav::OnDemandTiming, uav::PeriodicTiming, Topic> timing_;
  std::uint64_t seed_;
  std::uint64_t stream_;
  bool is_queued(bool latest) const { return queue_ > 1 && !latest; }
  /// The first index that a read from the queue at `t` can return.
  std::uint64_t oldest_unread(const uav::PeriodicTiming& timing, SimTime t) const;
  /// The first unread index that has not arrived by `t`. A driver delivers in order: later ones
  /// wait for it, even if they are available.
  std::uint64_t delivered_until(const uav::PeriodicTiming& timing, SimTime t) const;

  uav::Driver driver_;
  SimTime last_stamp_{};      ///< of those that were read
  std::uint64_t unread_ = 0;  ///< first index after the last one that was read
  std::uint32_t queue_ = 1;
  std::optional<std::uint64_t> queued_from_{};  ///< none: there was no queue yet
  /// What the latest answer of `delivered_until` was, and for which time.
  struct Delivered {
    SimTime at{};
    std::uint64_t end = 0;
  };
  mutable Delivered delivered_{};
};

}  // namespace tether::coordinator
