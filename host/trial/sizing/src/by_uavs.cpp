#include <algorithm>

#include <fmt/format.h>

#include <tether/sizing/sizing.h>

namespace tether::sizing {
namespace {

// So many flights without a miss make a level probably sufficient. One miss makes it doubtful.
constexpr std::size_t kProbes = 2;

}  // namespace

Share UavLevel::share(double confidence) const {
  return exact_share(reached, flights, confidence);
}

UavAnswer answer_by_uavs(const UavQuestion& question, std::span<const UavLevel> levels) {
  UavAnswer answer{.carried = question.least - 1, .too_many = question.most + 1};
  for (const UavLevel& level : levels) {
    const Share share = level.share(question.confidence);
    if (share.low >= question.success) answer.carried = std::max(answer.carried, level.uavs);
    if (share.high < question.success) answer.too_many = std::min(answer.too_many, level.uavs);
  }
  // More UAVs did better than fewer: what is insufficient counts.
  answer.carried = std::min(answer.carried, answer.too_many - 1);
  if (answer.is_decided()) return answer;
  const auto is_good = [&](const UavLevel& level) {
    return static_cast<double>(level.reached) >=
           question.success * static_cast<double>(level.flights);
  };
  std::size_t below = answer.carried, above = answer.too_many;  // probably sufficient, and not
  for (const UavLevel& level : levels)
    if (level.uavs > answer.carried && !is_good(level)) above = std::min(above, level.uavs);
  for (const UavLevel& level : levels)
    if (level.uavs < above && level.flights >= kProbes) below = std::max(below, level.uavs);
  if (below + 1 < above) {
    answer.next = {below + (above - below) / 2};
    return answer;
  }
  if (above != answer.too_many) answer.next.push_back(above);
  if (below != answer.carried) answer.next.push_back(below);
  std::ranges::stable_sort(answer.next, {}, [&](std::size_t uavs) {
    const auto at = std::ranges::find(levels, uavs, &UavLevel::uavs);
    return at == levels.end() ? 0 : at->flights;
  });
  return answer;
}

UavAxis::UavAxis(const UavQuestion& question) : question_(question) {
  for (std::size_t uavs = question.least; uavs <= question.most; ++uavs) levels_.push_back({uavs});
}

void UavAxis::add(std::size_t level, bool reached) {
  ++levels_[level].flights;
  levels_[level].reached += reached ? 1U : 0U;
}

std::vector<std::size_t> UavAxis::next_levels(std::size_t most) {
  answer_ = answer_by_uavs(question_, levels_);
  std::vector<std::size_t> next;
  for (std::size_t i = 0; i < most && !answer_.is_decided(); ++i)
    next.push_back(answer_.next[i % answer_.next.size()] - question_.least);
  return next;
}

std::string UavAxis::so_far() const {
  const bool is_least = answer_.carried >= question_.least;
  std::string known = is_least ? fmt::format("at least {}", answer_.carried) : "";
  if (answer_.too_many <= question_.most)
    known += fmt::format("{}fewer than {}", is_least ? ", " : "", answer_.too_many);
  return "UAVs that it carries: " + (known.empty() ? "nothing is known yet" : known);
}

}  // namespace tether::sizing
