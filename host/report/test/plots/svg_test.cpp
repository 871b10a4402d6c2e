#include "plots/svg.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::report {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

TEST(Svg, EscapesMarkup) {
  EXPECT_EQ(escape_markup("a<b> & \"c\" 'd'\x01"), "a&lt;b&gt; &amp; &quot;c&quot; &#39;d&#39;");
}

TEST(Svg, HasItsTitleAndNotItsProgram) {
  const auto svg = finished_svg(
      "<?xml version=\"1.0\"?>\n<svg \n width=\"9\">\n<title>p</title>\n<desc>Produced by "
      "X</desc>\n</svg>\n",
      "lag of <x>\x01");
  ASSERT_TRUE(svg);
  EXPECT_THAT(*svg, StartsWith("<?xml version=\"1.0\"?><svg width=\"9\" role=\"img\" "
                               "aria-label=\"lag of &lt;x&gt;?\">"
                               "<title>lag of &lt;x&gt;?</title><style>"));
  EXPECT_THAT(*svg, Not(HasSubstr("Produced")));
  EXPECT_THAT(*svg, HasSubstr("prefers-color-scheme:dark"));
}

TEST(Svg, PutsInksInPlaceOfColours) {
  const auto svg = finished_svg(
      "<svg ><path stroke='rgb(  1,   2,   3)' class=\"gridline\" d='M1'/>"
      "<polygon fill = 'rgb( 1, 2, 4)' color='rgb(1,2,0)' points=''/>"
      "<g stroke=\"rgb(9,9,9)\">x</g></svg>",
      "t");
  ASSERT_TRUE(svg);
  EXPECT_THAT(*svg,
              HasSubstr("<path stroke=\"#0072b2\" class=\"tp-stroke-3 gridline\" d=\"M1\"/>"));
  EXPECT_THAT(*svg, HasSubstr("<polygon fill=\"#d55e00\" color=\"#1f2328\" points=\"\" "
                              "class=\"tp-fill-4 tp-color-0\"/>"));
  EXPECT_THAT(*svg, HasSubstr("<g stroke=\"rgb(9,9,9)\">x</g>"));
}

TEST(Svg, KeepsTextAndDropsEmptyGroups) {
  const auto svg = finished_svg(
      "<svg ><g a='1'>\n</g>\n<g b='2'><text> 0.5 &lt; a</text></g>\n<g c='3'><g a='4'/></g></svg>",
      "t");
  EXPECT_THAT(svg.value(), EndsWith("</style><g b=\"2\"><text> 0.5 &lt; a</text></g></svg>"));
}

TEST(Svg, OfAnIncompleteDocumentIsNone) {
  for (const char* drawn : {"", "<?xml version='1.0'?>", "<svg><g></svg>", "<svg>"})
    EXPECT_FALSE(finished_svg(drawn, "t")) << drawn;
}

TEST(Svg, InAPageHasPrefixedIds) {
  const std::string svg = inline_svg(
      "<?xml?><svg ><style>.a{}</style><path id='p'/><g id=\"q\"/><use href='#p'/>"
      "<g fill='url(#q)'/></svg>",
      "f1-");
  EXPECT_EQ(svg,
            "<svg><path id=\"f1-p\"/><g id=\"f1-q\"/><use href=\"#f1-p\"/>"
            "<g fill=\"url(#f1-q)\"/></svg>");
}

}  // namespace
}  // namespace tether::report
