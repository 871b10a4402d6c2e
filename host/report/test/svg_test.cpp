#include "svg.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::report {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(Svg, EscapesMarkup) {
  EXPECT_EQ(escape_markup("a<b> & \"c\" 'd'\x01"), "a&lt;b&gt; &amp; &quot;c&quot; &#39;d&#39;");
}

TEST(Svg, NamesItselfAndNotItsProgram) {
  const std::string svg = finished_svg(
      "<?xml?>\n<svg \n width=\"9\">\n<title>p</title>\n<desc>Produced by X</desc>\n</svg>\n",
      "lag of <x>");
  EXPECT_THAT(svg, HasSubstr("<svg role=\"img\" aria-label=\"lag of &lt;x&gt;\""));
  EXPECT_THAT(svg, HasSubstr("<title>lag of &lt;x&gt;</title>"));
  EXPECT_THAT(svg, Not(HasSubstr("Produced")));
  EXPECT_THAT(svg, HasSubstr("prefers-color-scheme:dark"));
}

TEST(Svg, PutsInksInPlaceOfColours) {
  const std::string svg = finished_svg(
      "<svg ><path stroke='rgb(  1,   2,   3)' class=\"gridline\" d='M1'/>"
      "<polygon fill = 'rgb( 1, 2, 4)' points=''/><g stroke=\"rgb(9,9,9)\">x</g></svg>",
      "t");
  EXPECT_THAT(svg, HasSubstr("<path stroke='#0072b2' class=\"tp-stroke-3 gridline\" d='M1'/>"));
  EXPECT_THAT(svg, HasSubstr("<polygon fill = '#d55e00' points='' class=\"tp-fill-4\"/>"));
  EXPECT_THAT(svg, HasSubstr("<g stroke=\"rgb(9,9,9)\">x</g>"));
}

TEST(Svg, DropsGroupsWithNothingInThem) {
  const std::string svg = finished_svg("<svg ><g a='1'>\n</g>\n<g b='2'><path/></g>\n</svg>", "t");
  EXPECT_THAT(svg, Not(HasSubstr("<g a=")));
  EXPECT_THAT(svg, HasSubstr("<g b='2'><path/></g>"));
}

TEST(Svg, InAPageHasIdsOfItsOwn) {
  const std::string svg = inline_svg(
      "<?xml?><svg ><style>.a{}</style><path id='p'/><g id=\"q\"/><use href='#p'/>"
      "<g fill='url(#q)'/></svg>",
      "f1-");
  EXPECT_EQ(
      svg,
      "<svg ><path id='f1-p'/><g id=\"f1-q\"/><use href='#f1-p'/><g fill='url(#f1-q)'/></svg>");
}

}  // namespace
}  // namespace tether::report
