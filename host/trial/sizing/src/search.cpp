#include <algorithm>

#include <tether/sizing/sizing.h>

namespace tether::sizing {
namespace {

/// Gives up after so many failed flights of one call.
constexpr std::size_t kMostFailed = 3;

}  // namespace

SearchEnd search(Axis& axis, std::uint64_t most, std::size_t at_once,
                 std::span<const Wanted> earlier, const FlyThem& fly, const TakeOne& take_one) {
  std::uint64_t next_seed = 1;
  std::size_t flown = 0, failed = 0, copies = 0, without_value = 0;
  const auto take = [&](const Wanted& wanted) {
    const Flown is = take_one(wanted);
    ++(is.is_failed ? failed : flown);
    copies += is.is_copy ? 1U : 0U;
    without_value += is.lacks_value ? 1U : 0U;
    next_seed = std::max(next_seed, wanted.seed + 1);
  };
  std::ranges::for_each(earlier, take);
  failed = 0;
  while (failed < kMostFailed) {
    const std::size_t left = copies < kMostCopies ? most - (next_seed - 1) : 0;
    std::vector<Wanted> batch;
    for (const std::size_t level : axis.next_levels(std::min(at_once, left)))
      batch.push_back({level, next_seed++});
    if (batch.empty())
      return flown > 0 && without_value == flown ? SearchEnd::kUndecidable : SearchEnd::kAnswered;
    if (!fly(batch)) {
      axis.next_levels(0);
      return SearchEnd::kInterrupted;
    }
    std::ranges::for_each(batch, take);
  }
  return SearchEnd::kFailing;
}

}  // namespace tether::sizing
