#include "robustness.h"

#include <algorithm>
#include <limits>

#include <gmock/gmock.h>

#include <tether/base/random.h>

namespace tether::judge {
namespace {

using testing::ElementsAre;
using namespace std::chrono_literals;

// The definition, instant by instant: value j is in effect in [at[j], at[j + 1]).
double by_definition(const Holds& holds, const Trace& trace, std::size_t i) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t j = i; j < trace.at.size() && trace.at[j] <= trace.at[i] + holds.hold; ++j) {
    const double value = trace.signals[0][j];
    const double condition = holds.at_most ? -value : value;
    least = std::min(least, holds.is_never ? -condition : condition);
  }
  return least;
}

TEST(Robustness, EqualsTheDefinitionOnRandomSignals) {
  for (std::uint64_t index = 0; index < 10'000; ++index) {
    KeyedRandom random({.seed = 21, .stream = 1, .index = index});
    const auto below = [&](std::uint64_t n) { return random.bits() % n; };
    Trace trace{{}, {{}}};
    SimTime at(std::chrono::milliseconds(below(50)));
    for (std::size_t i = 1 + below(24); i > 0; --i) {
      trace.at.push_back(at);
      at += std::chrono::milliseconds(below(2) ? 10 : 1 + below(30));
      trace.signals[0].push_back(static_cast<double>(below(9)) - 4.0);
    }
    const Holds holds{below(2) == 0, below(2) == 0,
                      below(5) ? Duration(std::chrono::milliseconds(below(80))) : 1h};
    const std::vector<double> found = robustness(holds, trace.signals[0], trace.at);
    ASSERT_EQ(found.size(), trace.at.size());
    for (std::size_t i = 0; i < found.size(); ++i)
      ASSERT_EQ(found[i], by_definition(holds, trace, i)) << "draw " << index;
  }
}

// The values that RTAMT's tests publish for its discrete-time monitor (Nickovic and Yamaguchi,
// ATVA 2020), on its signal.
TEST(Robustness, EqualsPublishedExamples) {
  const std::vector<double> signal = {100, -1, -2, 5, -1};
  std::vector<SimTime> at;
  for (int s = 0; s < 5; ++s) at.emplace_back(std::chrono::seconds(s));
  EXPECT_THAT(robustness({.is_never = true}, signal, at), ElementsAre(-100, 1, 2, -5, 1));
  EXPECT_THAT(robustness({.hold = Duration::max()}, signal, at), ElementsAre(-2, -2, -2, -1, -1));
  EXPECT_THAT(robustness({.hold = 1s}, signal, at), ElementsAre(-1, -2, -2, -1, -1));
}

TEST(Robustness, OfAnEmptyTraceIsEmpty) {
  EXPECT_THAT(robustness({.hold = 1s}, {}, {}), ElementsAre());
}

}  // namespace
}  // namespace tether::judge
