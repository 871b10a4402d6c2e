#include "pages/verdict_html.h"

#include "pages/html.h"
#include "plots/svg.h"
#include "plots/verdict_picture.h"

namespace tether::report {
namespace {

/// What is between backticks is code.
std::string advice_list(const std::vector<std::string>& advice) {
  std::string html = "<ul>";
  for (const std::string& one : advice) {
    html += "<li>";
    bool is_code = false;
    for (const char c : escape_markup(one)) {
      html += c != '`' ? std::string(1, c) : is_code ? "</code>" : "<code>";
      is_code ^= c == '`';
    }
    html += "</li>";
  }
  return html + "</ul>\n";
}

}  // namespace

std::string answer_line(const Answer& answer) {
  return element("strong", answer.lead) + escape_markup(answer.rest);
}

std::string answer_block(const std::vector<Answer>& answers, const std::vector<std::string>& advice,
                         const std::string& heading) {
  std::string html = "<section class=\"answer\" aria-label=\"Answer\">\n";
  for (std::size_t i = 0; i < answers.size(); ++i)
    html +=
        std::string(i == 0 ? "<p class=\"first\">" : "<p>") + answer_line(answers[i]) + "</p>\n";
  if (!advice.empty()) html += element(heading, "What to do next") + advice_list(advice);
  return html + "</section>\n";
}

std::string answer_html(const std::vector<Verdict>& points, const std::string& heading) {
  return answer_block(answers_of(points), advice_of(points), heading);
}

std::string answers_html(const std::vector<std::vector<Verdict>>& groups) {
  const std::vector<Answer> headlines = headlines_of(groups);
  return headlines.empty() ? "" : answer_block(headlines, {});
}

std::string verdict_picture_html(const std::vector<std::vector<Verdict>>& groups) {
  const std::string drawing = verdict_picture(groups);
  if (drawing.empty()) return "";
  std::string caption =
      "Each sign is one flight: a dot reached the goal, a cross missed it, a ring failed "
      "and is not counted.";
  if (has_bars(groups))
    caption +=
        " A bar is the median computing time per image, by stage, and grey for waiting for shared "
        "cores. Its thin line ends at the time that 95 % of the images stay within. Dashed: the "
        "time until the camera's next image.";
  return figure(drawing, caption, "pair");
}

}  // namespace tether::report
