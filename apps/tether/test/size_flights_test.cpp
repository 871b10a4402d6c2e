#include "commands/size_flights.h"

#include <limits>

#include <gtest/gtest.h>

namespace tether::app {
namespace {

TEST(SizeProgress, SaysNoBoundsWhichFewFlightsDoNotShow) {
  const double none = std::numeric_limits<double>::infinity();
  EXPECT_EQ(known_text({}), "no limit is known yet");
  EXPECT_EQ(known_text({3.0, 0.0, none}), "no limit is known yet");
  for (const sizing::Threshold& bounded :
       {sizing::Threshold{3.24, 1.4, none}, {3.24, 0.0, 7.1}, {3.24, 1.4, 7.1}})
    EXPECT_EQ(known_text(bounded), "so far about 3.2 times slower");
}

}  // namespace
}  // namespace tether::app
