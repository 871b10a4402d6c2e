#include <algorithm>
#include <vector>

#include <tether/base/text.h>

namespace tether {
namespace {

// Optimal string alignment distance.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), now(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    now[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substitution = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      now[j] = std::min({last[j] + 1, now[j - 1] + 1, substitution});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) now[j] = std::min(now[j], before[j - 2] + 1);
    }
    std::swap(before, last);
    std::swap(last, now);
  }
  return last[b.size()];
}

std::string_view without_unit(std::string_view key) {
  for (const std::string_view unit : {"_s", "_ms", "_us", "_ns", "_deg", "_rad", "_hz", "_m"}) {
    if (key.ends_with(unit)) return key.substr(0, key.size() - unit.size());
  }
  return key;
}

bool differs_in_form_only(std::string_view word, std::string_view candidate) {
  const std::string_view stem = without_unit(word);
  return lower_case(word) == lower_case(candidate) || stem == without_unit(candidate) ||
         (stem.size() >= 3 && candidate.starts_with(stem));
}

}  // namespace

std::string_view nearest(std::string_view word, std::span<const std::string_view> candidates) {
  constexpr std::size_t kLongestWord = 64;
  if (word.size() > kLongestWord) return {};
  std::string_view best;
  std::size_t best_distance = std::max<std::size_t>(2, word.size() / 3 + 1);
  for (const std::string_view candidate : candidates) {
    const std::size_t distance =
        differs_in_form_only(word, candidate) ? 1 : edit_distance(word, candidate);
    if (distance >= best_distance) continue;
    best_distance = distance;
    best = candidate;
  }
  return best;
}

bool is_misspelt(std::string_view word, std::string_view candidate) {
  constexpr std::size_t kShortest = 4, kLongest = 64;
  return word.size() >= kShortest && word.size() <= kLongest &&
         edit_distance(word, candidate) == 1 && without_unit(word) != without_unit(candidate);
}

std::string quoted_list(std::span<const std::string_view> words) {
  if (words.empty()) return "none";
  std::string list;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) list += i + 1 == words.size() ? " and " : ", ";
    list.append("'").append(words[i]).append("'");
  }
  return list;
}

std::string allowed_hint(std::string_view word, std::span<const std::string_view> candidates) {
  const std::string_view guess = nearest(word, candidates);
  const std::string all = quoted_list(candidates);
  if (guess.empty()) return "allowed: " + all;
  return std::string("did you mean '").append(guess).append("'? Allowed: ") + all;
}

}  // namespace tether
