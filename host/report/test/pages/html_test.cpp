#include "pages/html.h"

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
  EXPECT_EQ(html,
            "<div class=\"scroll\"><table>\n<caption>a &lt;b&gt;</caption>\n<thead>\n"
            "<tr><td class=\"words\"></td><th scope=\"colgroup\" colspan=\"2\">Time (s)</th></tr>\n"
            "<tr><th scope=\"col\" class=\"words\">Where</th><th scope=\"col\">mean</th>"
            "<th scope=\"col\">sd</th></tr>\n</thead>\n<tbody>\n"
            "<tr><th scope=\"row\" class=\"words\">host &amp; co</th><td>1</td><td>2</td></tr>\n"
            "</tbody>\n</table></div>\n<ul class=\"notes\"><li>n &lt; 3</li></ul>\n");
  Table bare = table();
  bare.headings = {{{"", 1}, {"", 2}}};
  EXPECT_THAT(to_html(bare), Not(HasSubstr("<thead>")));
}

TEST(Html, TextsAreEscapedOnce) {
  EXPECT_EQ(element("p", "<script>&"), "<p>&lt;script&gt;&amp;</p>");
  EXPECT_EQ(list({"a<", "b"}), "<ul><li>a&lt;</li><li>b</li></ul>\n");
  EXPECT_THAT(folded("a<b", "<p>x</p>"), HasSubstr("<summary>a&lt;b</summary>\n<p>x</p>"));
  EXPECT_THAT(figure("<svg/>", "a<b", "plot"), HasSubstr("<figcaption>a&lt;b</figcaption>"));
  EXPECT_EQ(problems_box({}), "");
  EXPECT_THAT(problems_box({"seed 3 <failed>"}), HasSubstr("<li>seed 3 &lt;failed&gt;</li>"));
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
