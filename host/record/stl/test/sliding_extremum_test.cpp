#include "sliding_extremum.h"

#include <gmock/gmock.h>

namespace tether::stl {
namespace {

using ::testing::ElementsAre;

std::vector<double> slid(Extremum extremum, const std::vector<double>& values,
                         const std::vector<Window>& windows, std::size_t offset = 0) {
  std::vector<double> found(windows.size());
  slide(
      extremum, values, offset, [&](std::size_t i) { return windows[i]; }, found);
  return found;
}

TEST(SlidingExtremum, OfEachWindow) {
  const std::vector<double> values = {3, 1, 4, 1, 5, 9, 2, 6};
  const std::vector<Window> windows = {{0, 2}, {1, 3}, {1, 3}, {4, 5}, {7, 7}};
  EXPECT_THAT(slid(Extremum::kMin, values, windows), ElementsAre(1, 1, 1, 5, 6));
  EXPECT_THAT(slid(Extremum::kMax, values, windows), ElementsAre(4, 4, 4, 9, 6));
  EXPECT_THAT(slid(Extremum::kMax, values, {{10, 11}, {11, 12}}, 10), ElementsAre(3, 4));
}

TEST(SlidingExtremum, OfAnEmptyWindowIsNeutral) {
  constexpr double kNeutral = std::numeric_limits<double>::infinity();
  const std::vector<Window> windows = {{}, {0, 0}, {}};
  EXPECT_THAT(slid(Extremum::kMin, {7}, windows), ElementsAre(kNeutral, 7, kNeutral));
  EXPECT_THAT(slid(Extremum::kMax, {7}, windows), ElementsAre(-kNeutral, 7, -kNeutral));
}

TEST(SlidingExtremum, OfALongMonotoneWindow) {
  std::vector<double> values;
  std::vector<Window> windows;
  for (std::size_t i = 0; i < 1'000; ++i) {
    values.push_back(static_cast<double>(i));
    windows.push_back({i < 500 ? 0 : i - 500, i});
  }
  const std::vector<double> found = slid(Extremum::kMin, values, windows);
  for (std::size_t i = 0; i < windows.size(); ++i)
    EXPECT_EQ(found[i], static_cast<double>(windows[i].first));
}

}  // namespace
}  // namespace tether::stl
