#include "outcome_model.h"

#include <gtest/gtest.h>

namespace tether::sizing {
namespace {

TEST(OutcomeModel, KindsOfEachPartSumToOne) {
  for (const bool with_margins : {false, true}) {
    for (const double z : {-3.0, 0.0, 2.0}) {
      Likelihood sum;
      for (const Likelihood& kind : kind_probabilities(z, 0.3, with_margins)) {
        sum.curve += kind.curve;
        sum.lapse += kind.lapse;
        sum.floor += kind.floor;
      }
      EXPECT_NEAR(sum.curve, 1.0, 1e-12);
      EXPECT_EQ(sum.lapse, 1.0);
      EXPECT_EQ(sum.floor, 1.0);
    }
  }
}

// Midpoint rule over the near margins, and both far kinds.
TEST(OutcomeModel, LikelihoodOfAllMarginsIsOne) {
  constexpr int kSteps = 2000;
  constexpr double kStep = 2.0 * kFarMargin / kSteps, kZ = 0.7, kSpread = 0.2;
  const auto of = [&](double margin) {
    return likelihood({1.0, margin >= 0.0, margin}, kZ, kSpread);
  };
  Likelihood sum = of(-kFarMargin);
  sum.curve += of(kFarMargin).curve;
  sum.floor += of(kFarMargin).floor;
  for (int i = 0; i < kSteps; ++i) {
    const Likelihood part = of(-kFarMargin + (i + 0.5) * kStep);
    sum.curve += part.curve * kStep;
    sum.lapse += part.lapse * kStep;
    sum.floor += part.floor * kStep;
  }
  EXPECT_NEAR(sum.curve, 1.0, 1e-4);
  EXPECT_NEAR(sum.lapse, 1.0, 1e-3);
  EXPECT_NEAR(sum.floor, 1.0, 1e-3);
}

TEST(OutcomeModel, KindsGoFromMissedToReached) {
  const auto kind = [](bool reached, std::optional<double> margin) {
    return kind_of({1.0, reached, margin}, true);
  };
  EXPECT_EQ(kind(false, std::nullopt), 0U);
  EXPECT_EQ(kind(false, -2.0), 0U);
  EXPECT_EQ(kind(false, -0.1), 1U);
  EXPECT_EQ(kind(true, 0.0), 2U);
  EXPECT_EQ(kind(true, 0.3), 3U);
  EXPECT_EQ(kind(true, 0.9), 4U);
  EXPECT_EQ(kind_of({1.0, true, 0.1}, false), 1U);
  EXPECT_EQ(kind_of({1.0, false, -0.1}, false), 0U);
}

}  // namespace
}  // namespace tether::sizing
