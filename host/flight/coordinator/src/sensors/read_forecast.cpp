#include "sensors/read_forecast.h"

#include <algorithm>

namespace tether::coordinator {

void ReadForecast::requested(SimTime t, bool latest, std::uint64_t index) {
  if (expected_ && *expected_ != index) ++wrong_;
  expected_.reset();
  if (replied_at_) pauses_[pauses_seen_++ % kPauses] = t - *replied_at_;
  ++reads_;
  replied_at_.reset();
  latest_ = latest;
}

std::optional<std::uint64_t> ReadForecast::next(const SensorSchedule& schedule) {
  if (!replied_at_ || expected_ || pauses_seen_ < kPauses) return std::nullopt;
  if (reads_ < kReadsForEachWrong * (wrong_ + 1)) return std::nullopt;
  const auto [shortest, longest] = std::minmax_element(pauses_.begin(), pauses_.end());
  const std::uint64_t index = schedule.choose(*replied_at_ + *shortest, latest_).index;
  if (schedule.choose(*replied_at_ + *longest, latest_).index == index) expected_ = index;
  return expected_;
}

}  // namespace tether::coordinator
