#include "commands/size_flights.h"

#include <limits>

#include <gtest/gtest.h>

namespace tether::app {
namespace {

TEST(SizeProgress, SaysOnlyTheBoundsThatAreKnown) {
  const double none = std::numeric_limits<double>::infinity();
  EXPECT_EQ(known_text({}), "no limit is known yet");
  EXPECT_EQ(known_text({3.0, 0.0, none}), "no limit is known yet");
  EXPECT_EQ(known_text({3.24, 1.4, none}), "so far about 3.2 times slower, at least 1.4");
  EXPECT_EQ(known_text({3.24, 0.0, 7.1}), "so far about 3.2 times slower, at most 7.1");
  EXPECT_EQ(known_text({3.24, 1.4, 7.1}), "so far about 3.2 times slower, 1.4 to 7.1");
}

}  // namespace
}  // namespace tether::app
