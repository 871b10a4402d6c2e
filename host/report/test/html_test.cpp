#include "html.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tinyxml2.h>

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

TEST(Html, ATableSaysWhatEachHeadingHeads) {
  const std::string html = to_html(table());
  EXPECT_THAT(html, HasSubstr("<caption>a &lt;b&gt;</caption>"));
  EXPECT_THAT(html,
              HasSubstr("<td class=\"words\"></td><th scope=\"colgroup\" colspan=\"2\">Time"));
  EXPECT_THAT(html,
              HasSubstr("<th scope=\"col\" class=\"words\">Where</th><th scope=\"col\">mean"));
  EXPECT_THAT(html, HasSubstr("<th scope=\"row\" class=\"words\">host &amp; co</th><td>1</td>"));
  EXPECT_THAT(html, HasSubstr("<li>n &lt; 3</li>"));
  tinyxml2::XMLDocument document;
  EXPECT_EQ(document.Parse(("<x>" + html + "</x>").c_str()), tinyxml2::XML_SUCCESS);
}

TEST(Html, ATableWithoutHeadingsHasNoHead) {
  Table bare = table();
  bare.headings = {{{"", 1}, {"", 2}}};
  EXPECT_THAT(to_html(bare), Not(HasSubstr("<thead>")));
}

TEST(Html, TextsAreEscapedOnce) {
  EXPECT_EQ(element("p", "<script>&"), "<p>&lt;script&gt;&amp;</p>");
  EXPECT_EQ(list({"a<", "b"}), "<ul><li>a&lt;</li><li>b</li></ul>\n");
  EXPECT_THAT(folded("a<b", "<p>x</p>"), HasSubstr("<summary>a&lt;b</summary>\n<p>x</p>"));
  EXPECT_THAT(figure("<svg/>", "a<b", "plot"), HasSubstr("<figcaption>a&lt;b</figcaption>"));
}

TEST(Html, NoProblemsNoBox) {
  EXPECT_EQ(problems_box({}), "");
  EXPECT_THAT(problems_box({"seed 3 <failed>"}), HasSubstr("<li>seed 3 &lt;failed&gt;</li>"));
}

TEST(Html, APageSuitsLightDarkPhoneAndPaper) {
  const std::string page = html_page("a <title>", "<p>x</p>");
  EXPECT_TRUE(page.starts_with("<!DOCTYPE html>\n<html lang=\"en\">"));
  EXPECT_THAT(page, HasSubstr("<title>a &lt;title&gt;</title>"));
  EXPECT_THAT(page, HasSubstr("width=device-width"));
  EXPECT_THAT(page, HasSubstr("prefers-color-scheme:dark"));
  EXPECT_THAT(page, HasSubstr("@media print"));
  EXPECT_THAT(page, HasSubstr(".tp-stroke-3"));
}

}  // namespace
}  // namespace tether::report
