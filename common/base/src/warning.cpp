#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include <tether/base/error.h>

namespace tether {
namespace {

struct Words {
  std::string_view name;
  std::string_view heading;
};
constexpr std::array<Words, kConsequences.size()> kWords = {
    {{"doubtful", "doubtful"},
     {"missing", "missing from the world"},
     {"looks_different", "looks different"},
     {"behaves_differently", "moves, collides or measures differently"},
     {"no_effect", "no effect here"}}};

const Words& words_of(Consequence consequence) {
  return kWords.at(static_cast<std::size_t>(consequence));
}

/// "<script>" of "<script> of visual 'v'", "visual" of "visual 'v'".
std::string kind_of(const Warning& warning) {
  return warning.subject.substr(0, warning.subject.find(' '));
}

/// "12 plugin, 3 <script>": the most frequent one first.
std::string kinds_of(const std::vector<Warning>& warnings) {
  std::map<std::string, std::size_t> counts;
  for (const Warning& warning : warnings) ++counts[kind_of(warning)];
  std::vector<std::pair<std::string, std::size_t>> kinds(counts.begin(), counts.end());
  std::ranges::stable_sort(kinds, std::greater<>(), &std::pair<std::string, std::size_t>::second);
  std::string text;
  for (const auto& [kind, count] : kinds)
    text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + kind;
  return text;
}

}  // namespace

std::string_view name(Consequence consequence) {
  return words_of(consequence).name;
}

WarningSink printable_warnings(WarningSink warn) {
  if (!warn) return warn;
  return [warn = std::move(warn)](const Warning& given) {
    Warning warning = given;
    for (std::string* text : {&warning.where.file, &warning.subject, &warning.message})
      *text = printable(*text);
    warn(warning);
  };
}

std::string to_line(const Warning& warning) {
  const std::string line = warning.subject + " " + warning.message;
  return warning.where.file.empty() ? line : located(warning.where, line);
}

std::string grouped(std::span<const Warning> warnings, std::size_t most) {
  std::string text;
  for (const Consequence consequence : kConsequences) {
    std::vector<Warning> group;
    std::ranges::copy_if(warnings, std::back_inserter(group), [&](const Warning& warning) {
      return warning.consequence == consequence;
    });
    if (group.empty()) continue;
    text += std::string(words_of(consequence).heading) + " (" + std::to_string(group.size()) + ")";
    if (group.size() > most) {
      text += ": " + kinds_of(group) + "\n";
      continue;
    }
    text += ":\n";
    for (const Warning& warning : group) text += "  " + to_line(warning) + "\n";
  }
  return text;
}

}  // namespace tether
