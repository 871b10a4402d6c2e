#include "workload.h"

#include "frames.h"

#include <cmath>

#include <gmock/gmock.h>

namespace tether::calibration {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::SizeIs;

/// Clocks that move by a step with each reading.
struct Ticking {
  Duration cpu{0}, wall{0};
  Stopwatch stopwatch() {
    return {[this] { return cpu += std::chrono::milliseconds(6); },
            [this] { return wall += std::chrono::milliseconds(12); }};
  }
};

TEST(CalibrationFrames, AreTheSameOnEveryMachine) {
  const auto frames = calibration_frames();
  ASSERT_TRUE(frames) << frames.failure().message;
  ASSERT_EQ(frames->size(), expected_views().size());
  // FNV-1a over all bytes, noise included.
  std::uint64_t digest = 14695981039346656037ULL;
  for (const auto& frame : *frames) {
    for (const std::uint8_t byte : frame.rgb) digest = (digest ^ byte) * 1099511628211ULL;
  }
  EXPECT_EQ(digest, 3829771562105179721ULL);
}

// Also that this machine finds what every machine must.
TEST(Workload, TimesEveryBlockOncePerRoundAndImage) {
  Ticking clock;
  std::vector<std::string> told;
  const auto blocks = run_workload({.rounds = 2, .warm_up = 1}, clock.stopwatch(),
                                   [&](const std::string& what) { told.push_back(what); });
  ASSERT_TRUE(blocks) << blocks.failure().message;
  EXPECT_THAT(told, ElementsAre("warming up", "round 1 of 2", "round 2 of 2"));
  std::vector<std::string> names;
  for (const BlockTimes& block : blocks->blocks) {
    names.push_back(block.name);
    EXPECT_THAT(block.cpu_ms, SizeIs(2)) << block.name;
    EXPECT_THAT(block.wall_ms, SizeIs(2)) << block.name;
    // One step per image; of the positions, of which an image has many, a share.
    const double share = block.name == "position" ? 1.0 / 2000 : 1.0;
    EXPECT_THAT(block.cpu_ms, Each(::testing::DoubleNear(6.0 * share, 1e-9))) << block.name;
    EXPECT_THAT(block.wall_ms, Each(::testing::DoubleNear(12.0 * share, 1e-9))) << block.name;
  }
  EXPECT_THAT(names, ElementsAre("prefilter", "back_projection", "tracking", "search", "position",
                                 kWholeStep));
}

TEST(Workload, DetectsDifferentResults) {
  const View expected = expected_views().front();
  EXPECT_EQ(difference(expected, expected), "");
  View other = expected;
  other.u_px += 0.1;
  EXPECT_NE(difference(other, expected), "");
  other = expected;
  other.height_px = NAN;
  EXPECT_NE(difference(other, expected), "");
  other = expected;
  other.distance_m *= 1.01;
  EXPECT_NE(difference(other, expected), "");
  EXPECT_NE(difference(std::nullopt, expected), "");
}

}  // namespace
}  // namespace tether::calibration
