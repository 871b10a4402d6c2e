#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <tether/report/verdict.h>

// Answers and advice as text.
namespace tether::report {

namespace {

/// Around the lead of an answer: bold, and on a terminal green, red or yellow by its ruling, if it
/// has one.
std::pair<std::string, std::string> marks_of(std::optional<Ruling> ruling, Markup markup) {
  if (markup == Markup::kPlain) return {};
  if (markup == Markup::kMarkdown) return {"**", "**"};
  const bool is_good = ruling == Ruling::kFastEnough || ruling == Ruling::kFastEnoughSoFar;
  const char* const colour = !ruling                            ? ""
                             : is_good                          ? ";32"
                             : ruling == Ruling::kNotFastEnough ? ";31"
                                                                : ";33";
  return {fmt::format("\x1b[1{}m", colour), "\x1b[0m"};
}

}  // namespace

std::string answer_text(const std::vector<Answer>& answers, const std::vector<std::string>& advice,
                        Markup markup) {
  const bool is_markdown = markup == Markup::kMarkdown;
  std::string text;
  for (const Answer& answer : answers) {
    const auto [before, after] = marks_of(answer.ruling, markup);
    text += fmt::format("{}{}{}{}\n{}", before, answer.lead, after, answer.rest,
                        is_markdown ? "\n" : "");
  }
  for (std::string one : advice) {
    if (!is_markdown) std::erase(one, '`');
    text += fmt::format("{}{}\n", is_markdown ? "- " : "  → ", one);
  }
  return text + "\n";
}

std::string verdict_text(const std::vector<Verdict>& verdicts, Markup markup) {
  const auto groups = by_scenario(verdicts);
  const std::vector<Answer> headlines = headlines_of(groups);
  std::string text = headlines.empty() ? "" : answer_text(headlines, {}, markup);
  for (const std::vector<Verdict>& points : groups) {
    if (groups.size() > 1)
      text += fmt::format("{}{}\n\n", markup == Markup::kMarkdown ? "## " : "",
                          points.front().scenario);
    text += answer_text(answers_of(points), advice_of(points), markup);
  }
  return text;
}

}  // namespace tether::report
