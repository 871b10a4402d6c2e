#include "pages/html.h"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::report {
namespace {

using testing::HasSubstr;
using testing::Not;

Table table() {
  Table table;
  table.title = "a <b>";
  table.headings = {{{"", 1}, {"Time (s)", 2}}, {{"Where", 1}, {"mean", 1}, {"sd", 1}}};
  table.rows = {{"host & co", "1", "2"}};
  table.notes = {"n < 3"};
  return table;
}

TEST(Html, ATableHasTheScopeOfItsHeadings) {
  const std::string html = to_html(table());
  EXPECT_EQ(
      html,
      "<div class=\"scroll\" role=\"group\" tabindex=\"0\" aria-label=\"a &lt;b&gt;\"><table>\n"
      "<caption>a &lt;b&gt;</caption>\n<thead>\n"
      "<tr><td class=\"words\"></td><th scope=\"colgroup\" colspan=\"2\">Time (s)</th></tr>\n"
      "<tr><th scope=\"col\" class=\"words\">Where</th><th scope=\"col\">mean</th>"
      "<th scope=\"col\">sd</th></tr>\n</thead>\n<tbody>\n"
      "<tr><th scope=\"row\" class=\"words\">host &amp; co</th><td>1</td><td>2</td></tr>\n"
      "</tbody>\n</table></div>\n<ul class=\"notes\"><li>n &lt; 3</li></ul>\n");
  Table bare = table();
  bare.headings = {{{"", 1}, {"", 2}}};
  EXPECT_THAT(to_html(bare), Not(HasSubstr("<thead>")));
  bare.title.clear();
  EXPECT_THAT(to_html(bare, "a<"), HasSubstr("aria-label=\"a&lt;\"><table aria-label=\"a&lt;\">"));
}

TEST(Html, TextsAreEscapedOnce) {
  EXPECT_EQ(element("p", "<script>&"), "<p>&lt;script&gt;&amp;</p>");
  EXPECT_EQ(list({"a<", "b"}), "<ul><li>a&lt;</li><li>b</li></ul>\n");
  EXPECT_THAT(folded("a<b", "<p>x</p>"), HasSubstr("<summary>a&lt;b</summary>\n<p>x</p>"));
  EXPECT_THAT(figure("<svg/>", "a<b", "plot"), HasSubstr("<figcaption>a&lt;b</figcaption>"));
  EXPECT_THAT(figure("<svg aria-label=\"Path &amp; x\"/>", "", "plot"),
              HasSubstr("tabindex=\"0\" aria-label=\"Path &amp; x\">"));
  EXPECT_EQ(problems_box({}), "");
  EXPECT_THAT(problems_box({"seed 3 <failed>"}), HasSubstr("<li>seed 3 &lt;failed&gt;</li>"));
}

// Relative luminance and contrast as in WCAG 2.1.
double luminance(const std::string& colour) {
  double sum = 0.0;
  const double weights[] = {0.2126, 0.7152, 0.0722};
  const bool is_short = colour.size() == 4;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string digits =
        is_short ? std::string(2, colour[i + 1]) : colour.substr(2 * i + 1, 2);
    const double value = std::stoi(digits, nullptr, 16) / 255.0;
    sum += weights[i] * (value <= 0.03928 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4));
  }
  return sum;
}

double contrast(const std::string& a, const std::string& b) {
  const auto [dark, light] = std::minmax({luminance(a), luminance(b)});
  return (light + 0.05) / (dark + 0.05);
}

/// The first colour of `name` in the CSS after `from`.
std::string colour_of(const std::string& css, const std::string& name, std::size_t from) {
  const std::size_t begin = css.find("--" + name + ":", from) + name.size() + 3;
  return css.substr(begin, css.find_first_of(";}", begin) - begin);
}

TEST(Html, TextHasEnoughContrastWithItsGround) {
  const std::string css = html_page("", "");
  for (const std::size_t theme : {css.find(":root"), css.find("prefers-color-scheme:dark")})
    for (const char* ground : {"ground", "band", "note", "bad"})
      for (const char* text : {"text", "soft", "accent"})
        EXPECT_GE(contrast(colour_of(css, text, theme), colour_of(css, ground, theme)), 4.5)
            << text << " on " << ground << " from " << theme;
}

TEST(Html, APageSuitsLightDarkPhoneAndPaper) {
  const std::string page = html_page("a <title>", "<p>x</p>");
  EXPECT_TRUE(page.starts_with("<!DOCTYPE html>\n<html lang=\"en\">"));
  for (const char* part : {"<title>a &lt;title&gt;</title>", "width=device-width",
                           "prefers-color-scheme:dark", "@media print", ".tp-stroke-3"})
    EXPECT_THAT(page, HasSubstr(part));
}

}  // namespace
}  // namespace tether::report
