#include "shutter.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace tether::sim {
namespace {

raster::View view_of(double exposure_s, double readout_s, int rows) {
  raster::View view;
  view.camera.height_px = rows;
  view.exposure_s = exposure_s;
  view.readout_s = readout_s;
  return view;
}

// The mean instant of a row's light, in seconds before the end.
double mean_age_s(const raster::View& s, int row, int instants) {
  double age_s = 0.0;
  for (int i = 0; i < instants; ++i) {
    age_s += row_weight(s, row, i, instants) * window_s(s) * (instants - 1 - i) / (instants - 1);
  }
  return age_s;
}

TEST(ShutterTest, WeightsOfEachRowAreSharesOfOne) {
  for (const auto& [exposure_s, readout_s] :
       {std::pair{0.01, 0.0}, {0.0, 0.03}, {0.02, 0.01}, {1e-9, 0.03}, {0.01, 1e-9}}) {
    for (const int instants : {1, 2, 3, 7, 32}) {
      for (const int rows : {1, 2, 9, 480}) {
        const raster::View s = view_of(exposure_s, readout_s, rows);
        for (int row = 0; row < rows; ++row) {
          double sum = 0.0;
          for (int i = 0; i < instants; ++i) {
            EXPECT_GE(row_weight(s, row, i, instants), -1e-12);
            sum += row_weight(s, row, i, instants);
          }
          EXPECT_NEAR(sum, 1.0, 1e-6) << exposure_s << ' ' << readout_s << ' ' << instants;
        }
      }
    }
  }
}

// Weights that are linear in time keep the mean of every row's exposure, wherever it lies.
TEST(ShutterTest, EachRowIsSeenAtTheMiddleOfItsExposure) {
  const raster::View s = view_of(0.012, 0.03, 5);
  for (const int instants : {2, 3, 8, 32}) {
    for (int row = 0; row < 5; ++row) {
      EXPECT_NEAR(mean_age_s(s, row, instants), 0.006 + 0.03 * (4 - row) / 4.0, 1e-9);
    }
  }
}

TEST(ShutterTest, RollingRowsAreInstants) {
  const raster::View s = view_of(0.0, 0.04, 5);
  for (int row = 0; row < 5; ++row) {
    for (int i = 0; i < 5; ++i) EXPECT_NEAR(row_weight(s, row, i, 5), row == i ? 1.0 : 0.0, 1e-12);
  }
  EXPECT_NEAR(row_weight(s, 1, 0, 3), 0.5, 1e-12);
  EXPECT_NEAR(row_weight(s, 1, 1, 3), 0.5, 1e-12);
  EXPECT_EQ(row_weight(s, 4, 31, 32), 1.0) << "the last row ends the window";
}

TEST(ShutterTest, AboutAPixelBetweenInstants) {
  EXPECT_EQ(count_instants(0.0), 1);
  EXPECT_EQ(count_instants(1e-4), 1) << "moves no byte";
  EXPECT_EQ(count_instants(0.3), 2);
  EXPECT_EQ(count_instants(1.0), 2);
  EXPECT_EQ(count_instants(4.2), 6);
  EXPECT_EQ(count_instants(1000.0), kMaxInstants);
  EXPECT_EQ(count_instants(std::numeric_limits<double>::infinity()), kMaxInstants);
}

}  // namespace
}  // namespace tether::sim
