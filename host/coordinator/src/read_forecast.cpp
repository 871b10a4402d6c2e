#include "read_forecast.h"

#include <algorithm>

namespace tether::coordinator {

void ReadForecast::requested(SimTime t, bool latest) {
  if (replied_at_) pauses_[count_++ % kPauses] = t - *replied_at_;
  replied_at_.reset();
  latest_ = latest;
}

std::optional<std::uint64_t> ReadForecast::next(const SensorSchedule& schedule) const {
  if (!replied_at_ || count_ < kFewestPauses) return std::nullopt;
  const auto end = pauses_.begin() + static_cast<std::ptrdiff_t>(std::min(count_, kPauses));
  const auto [shortest, longest] = std::minmax_element(pauses_.begin(), end);
  const std::uint64_t index = schedule.choose(*replied_at_ + *shortest, latest_).index;
  if (schedule.choose(*replied_at_ + *longest, latest_).index != index) return std::nullopt;
  return index;
}

}  // namespace tether::coordinator
