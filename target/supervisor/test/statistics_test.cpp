#include "statistics.h"

#include <gmock/gmock.h>

namespace tether::supervisor {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::Not;

TEST(Statistics, ReportsQuantilesInMicrosecondsAndTheRate) {
  Statistics statistics;
  EXPECT_THAT(statistics.report(Duration(0)), HasSubstr(" 0 stops per second"));
  for (int i = 1; i <= 21; ++i) statistics.froze(i * 1us);
  statistics.thawed(5us);
  const std::string report = statistics.report(3s);
  EXPECT_THAT(report, HasSubstr("3.000 s of execution time, 7 stops per second of it\n"));
  EXPECT_THAT(report,
              HasSubstr("freeze        21 times; µs: median 11, 95 % within 20, longest 21\n"));
  EXPECT_THAT(report, HasSubstr("thaw           1 times; µs: median 5,"));
  EXPECT_THAT(report, Not(HasSubstr("overshoot")));
}

}  // namespace
}  // namespace tether::supervisor
