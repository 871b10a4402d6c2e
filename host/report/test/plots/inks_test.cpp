#include "plots/inks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::report {
namespace {

using testing::HasSubstr;

TEST(Inks, AreFoundAgainInADrawing) {
  EXPECT_EQ(gnuplot_colour(Ink::kSeries), "rgb '#010203'");
  EXPECT_EQ(find_ink("rgb(  1,   2,   3)"), Ink::kSeries);
  EXPECT_EQ(find_ink("rgb(1,2,0)"), Ink::kForeground);
}

TEST(Inks, OtherColoursAreNotInks) {
  for (const char* colour : {"rgb(1,2,200)", "rgb(2,2,3)", "rgb(1,3,3)", "black", "rgb(", "rgb(1)"})
    EXPECT_FALSE(find_ink(colour)) << colour;
}

TEST(Inks, OfSeriesRepeat) {
  EXPECT_NE(series_ink(0), series_ink(1));
  EXPECT_EQ(series_ink(kSeriesInks), series_ink(0));
}

TEST(Inks, HaveAColourForEachBackground) {
  const std::string css = ink_css();
  const auto dark = css.find("prefers-color-scheme:dark");
  ASSERT_NE(dark, std::string::npos);
  EXPECT_THAT(css.substr(0, dark), HasSubstr(".tp-stroke-3{stroke:#0072b2}"));
  EXPECT_THAT(css.substr(dark), HasSubstr(".tp-stroke-3{stroke:#56b4e9}"));
}

}  // namespace
}  // namespace tether::report
