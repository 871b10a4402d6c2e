#include <cmath>

#include <gtest/gtest.h>

#include <tether/stats/sample_statistics.h>

namespace tether::stats {
namespace {

TEST(SampleStatistics, Mean) {
  EXPECT_EQ(mean({4.0}), 4.0);
  EXPECT_EQ(mean({1.0, 2.0, 6.0}), 3.0);
}

TEST(SampleStatistics, TheSpreadIsThatOfASample) {
  EXPECT_FALSE(sample_stddev({4.0}));
  EXPECT_FALSE(sample_stddev({}));
  EXPECT_DOUBLE_EQ(*sample_stddev({1.0, 3.0}), std::sqrt(2.0));
  EXPECT_EQ(*sample_stddev({5.0, 5.0, 5.0}), 0.0);
}

TEST(SampleStatistics, QuantilesAreInterpolated) {
  EXPECT_EQ(quantile({4.0}, 0.95), 4.0);
  EXPECT_EQ(quantile({1.0, 2.0, 9.0}, 0.5), 2.0);
  EXPECT_EQ(quantile({1.0, 2.0, 4.0, 9.0}, 0.5), 3.0);
  EXPECT_EQ(quantile({0.0, 10.0}, 0.25), 2.5);
  EXPECT_EQ(quantile({1.0, 2.0, 9.0}, 0.0), 1.0);
  EXPECT_EQ(quantile({1.0, 2.0, 9.0}, 1.0), 9.0);
}

}  // namespace
}  // namespace tether::stats
