#include "sensors/sensor_schedule.h"

#include <algorithm>
#include <utility>

namespace tether::coordinator {

SensorSchedule::SensorSchedule(const uav::SensorTiming& timing, std::uint64_t seed,
                               std::uint64_t stream, uav::Driver driver)
    : seed_(seed), stream_(stream), driver_(driver) {
  std::visit([this](const auto& t) { timing_ = t; }, timing);
}

SensorSchedule SensorSchedule::in_free_running(const uav::SensorTiming& timing,
                                               uav::Driver driver) {
  SensorSchedule schedule(uav::OnDemandTiming{uav::ConstantDelay{Duration(0)}}, 0, 0, driver);
  if (const auto* periodic = std::get_if<uav::PeriodicTiming>(&timing))
    schedule.timing_ = Topic{*periodic};
  return schedule;
}

Measurement SensorSchedule::periodic(const uav::PeriodicTiming& timing, std::uint64_t index) const {
  const SimTime instant = uav::sampling_instant(timing, index);
  const SimTime available_at = instant + uav::draw(timing.delay, {seed_, stream_, index});
  const std::uint64_t content = driver_.content_of(index);
  return stamped({index, uav::sampling_instant(timing, content), available_at, index - content},
                 instant);
}

// A repeated measurement has a stamp of its own, as drivers stamp what they deliver. Only the
// stamps of what is sampled at a read can be out of order.
Measurement SensorSchedule::stamped(Measurement measurement, SimTime instant) const {
  if (driver_.is_modelled())
    measurement.stamp = std::max(last_stamp_, driver_.stamp(instant, measurement.index));
  return measurement;
}

std::uint64_t SensorSchedule::next_arriving(std::uint64_t index) const {
  while (driver_.loses(index)) ++index;
  return index;
}

std::optional<std::uint64_t> SensorSchedule::newest_arriving(std::uint64_t first,
                                                             std::uint64_t end) const {
  for (std::uint64_t k = end; k-- > first;)
    if (!driver_.loses(k)) return k;
  return std::nullopt;
}

std::optional<std::uint64_t> SensorSchedule::newest_sampled(const uav::PeriodicTiming& timing,
                                                            SimTime t) {
  const Duration since_phase = t.time_since_epoch() - timing.phase;
  if (since_phase < Duration(0)) return std::nullopt;
  return static_cast<std::uint64_t>(since_phase / timing.period);
}

// Walks back from the last measurement that was sampled by t. Delays may reorder what becomes
// available, so the first hit from the newest side is the answer.
std::optional<Measurement> SensorSchedule::newest_available(const uav::PeriodicTiming& timing,
                                                            SimTime t, std::uint64_t first) const {
  const auto newest = newest_sampled(timing, t);
  if (!newest) return std::nullopt;
  for (std::uint64_t k = *newest + 1; k-- > first;) {
    if (driver_.loses(k)) continue;
    const Measurement candidate = periodic(timing, k);
    if (candidate.available_at <= t) return candidate;
  }
  return std::nullopt;
}

// The least availability from `first` on: no later measurement can beat one that is available
// before it is sampled.
Measurement SensorSchedule::next_available(const uav::PeriodicTiming& timing,
                                           std::uint64_t first) const {
  first = next_arriving(first);
  Measurement best = periodic(timing, first);
  for (std::uint64_t k = first + 1; uav::sampling_instant(timing, k) < best.available_at; ++k) {
    if (driver_.loses(k)) continue;
    const Measurement candidate = periodic(timing, k);
    if (candidate.available_at < best.available_at) best = candidate;
  }
  return best;
}

Measurement SensorSchedule::choose(SimTime t, bool latest) const {
  if (const auto* timing = std::get_if<uav::OnDemandTiming>(&timing_))
    return stamped({unread_, t, t + uav::draw(timing->delay, {seed_, stream_, unread_})}, t);
  if (const auto there = choose_available(t, latest)) return *there;
  if (const auto* timing = std::get_if<uav::PeriodicTiming>(&timing_))
    return is_queued(latest) ? periodic(*timing, oldest_unread(*timing, t))
                             : next_available(*timing, unread_);
  const std::uint64_t index = next_arriving(unread_);
  const SimTime next = uav::sampling_instant(std::get<Topic>(timing_).timing, index);
  return stamped({index, next, next}, next);
}

std::optional<Measurement> SensorSchedule::choose_available(SimTime t, bool latest) const {
  if (const auto* timing = std::get_if<uav::PeriodicTiming>(&timing_)) {
    if (!is_queued(latest)) return newest_available(*timing, t, latest ? 0 : unread_);
    const Measurement oldest = periodic(*timing, oldest_unread(*timing, t));
    return oldest.available_at <= t ? std::optional(oldest) : std::nullopt;
  }
  const auto sampled = newest_sampled(std::get<Topic>(timing_).timing, t);
  if (!sampled) return std::nullopt;
  const auto newest = newest_arriving(latest ? 0 : unread_, *sampled + 1);
  return newest ? std::optional(stamped({*newest, t, t}, t)) : std::nullopt;
}

// What a shorter queue has dropped does not come back.
void SensorSchedule::set_queue(std::uint32_t queue, SimTime t) {
  const auto* timing = std::get_if<uav::PeriodicTiming>(&timing_);
  if (timing && queue > queue_) {
    const auto newest = newest_available(*timing, t, 0);
    const std::uint64_t first = queue_ > 1 ? oldest_unread(*timing, t) : newest ? newest->index : 0;
    queued_from_ = std::max(queued_from_.value_or(0), first);
  }
  queue_ = queue;
}

// Reads and looks ahead mostly come with growing t, and then begin where the last one ended.
std::uint64_t SensorSchedule::delivered_until(const uav::PeriodicTiming& timing, SimTime t) const {
  const bool is_later = t >= delivered_.at;
  std::uint64_t end = std::max({unread_, queued_from_.value_or(0), is_later ? delivered_.end : 0});
  const auto newest = newest_sampled(timing, t);
  while (newest && end <= *newest &&
         (driver_.loses(end) || periodic(timing, end).available_at <= t))
    ++end;
  if (is_later) delivered_ = {t, end};
  return end;
}

std::uint64_t SensorSchedule::oldest_unread(const uav::PeriodicTiming& timing, SimTime t) const {
  const std::uint64_t begin = std::max(unread_, queued_from_.value_or(0));
  std::uint64_t first = delivered_until(timing, t);
  for (std::uint32_t kept = 0; kept < queue_; ++kept) {
    const auto before = newest_arriving(begin, first);
    if (!before) break;
    first = *before;
  }
  return next_arriving(first);
}

// A queue fills from the first read on.
std::uint64_t SensorSchedule::unqueued(const Measurement& measurement, std::uint32_t queue) const {
  const bool waits = std::holds_alternative<uav::PeriodicTiming>(timing_);
  if (!is_periodic() || unread_ == 0 || queue < 2) return 0;
  const std::uint64_t begin = waits ? std::max(unread_, queued_from_.value_or(0)) : unread_;
  std::uint64_t count = 0;
  for (std::uint64_t k = std::max(measurement.index, begin);
       k-- > begin && (waits || count + 1 < queue);)
    if (!driver_.loses(k)) ++count;
  return count;
}

void SensorSchedule::mark_read(const Measurement& measurement) {
  unread_ = std::max(unread_, measurement.index + 1);
  last_stamp_ = std::max(last_stamp_, measurement.stamp.value_or(SimTime{}));
}

std::optional<SimTime> SensorSchedule::sampling_instant(std::uint64_t index) const {
  const auto* timing = std::get_if<uav::PeriodicTiming>(&timing_);
  return timing ? std::optional(uav::sampling_instant(*timing, index)) : std::nullopt;
}

std::uint64_t SensorSchedule::first_readable(SimTime t) const {
  const auto* timing = std::get_if<uav::PeriodicTiming>(&timing_);
  if (!timing) return unread_;
  const auto newest = newest_available(*timing, t, 0);
  if (!newest) return 0;
  const std::uint64_t first =
      is_queued(false) ? std::min(newest->index, oldest_unread(*timing, t)) : newest->index;
  return driver_.content_of(first);
}

}  // namespace tether::coordinator
