#include "sensors/navigation.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include <tether/sim/geodesy.h>

namespace tether::sim {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using uav::Vec3;

constexpr std::uint64_t kSeeds = 4000;

struct Spread {
  double mean = 0.0;
  double stddev = 0.0;
};

/// Over many seeds.
Spread over_seeds(const std::function<double(const MeasurementKey&)>& error, SimTime at) {
  double sum = 0.0, squares = 0.0;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const double e = error({seed, "alpha", "sensor", 3, at});
    sum += e;
    squares += e * e;
  }
  const double mean = sum / kSeeds;
  return {mean, std::sqrt(squares / kSeeds - mean * mean)};
}

/// That the errors have that spread; of n values, a standard deviation has an error of σ/√2n.
void expect_spread(const Spread& got, double mean, double stddev) {
  EXPECT_NEAR(got.mean, mean, 5.0 * stddev / std::sqrt(kSeeds));
  EXPECT_NEAR(got.stddev, stddev, 5.0 * stddev / std::sqrt(2.0 * kSeeds));
}

/// White 1, bias 2, and a walk of stationary standard deviation 3, one correlation time later.
const Noise kNoise{0.5, 1.0, 0.25, 2.0, 3.0 / std::sqrt(5.0), 10.0};
const SimTime kLater{seconds(10)};
const double kStddev = std::sqrt(1.0 + 4.0 + 9.0 * (1.0 - std::exp(-2.0)));

const TrueMotion kTruth{
    {{10.0, 20.0, 30.0}, uav::from_rpy(0.1, 0.2, 0.3)}, {1.0, 2.0, 3.0}, {0.1, 0.2, 0.3}};

TEST(TrueMotion, IsThatOfTheMountedFrame) {
  const uav::Pose X_WB{{1.0, 0.0, 0.0}, uav::from_rpy(0.0, 0.0, 0.5 * std::numbers::pi)};
  const uav::Pose X_BS{{0.5, 0.0, 0.0}, uav::from_rpy(0.0, 0.0, std::numbers::pi)};
  const BodyMotion motion{{0.0, 0.0, 2.0}, {}, {}, {0.0, 0.0, 3.0}};
  const TrueMotion got = motion_of_sensor(X_WB, motion, X_BS);
  EXPECT_LT(norm(got.X_WS.p - Vec3{1.0, 0.5, 0.0}), 1e-12);
  EXPECT_LT(norm(got.v_WS_W - Vec3{-1.0, 0.0, 3.0}), 1e-12) << "the lever turns with 2 rad/s";
  EXPECT_LT(norm(got.w_WS_S - Vec3{0.0, 0.0, 2.0}), 1e-12);
}

TEST(NavSat, WithoutNoiseGivesPlaceAndVelocity) {
  const Place place{12.0, 34.0, 56.0, 0.4};
  const uav::NavSatSample got = measure_navsat({}, kTruth, place, {1, "alpha", "gps", 7, kLater});
  const Geodetic truth = geodetic_of(place, kTruth.X_WS.p);
  EXPECT_TRUE(got.has_fix);
  EXPECT_EQ(got.sampled_at, kLater);
  EXPECT_EQ(got.index, 7U);
  EXPECT_EQ(got.latitude_deg, truth.latitude_deg);
  EXPECT_EQ(got.longitude_deg, truth.longitude_deg);
  EXPECT_EQ(got.altitude_m, truth.altitude_m);
  EXPECT_EQ(got.velocity_ENU_m_s, to_enu(place, kTruth.v_WS_W));
  EXPECT_EQ(got.horizontal_accuracy_m, 0.0);
}

TEST(NavSat, ErrorsHaveTheSpreadThatItReports) {
  NavSatModel model;
  model.horizontal_m = model.vertical_velocity_m_s = kNoise;
  model.vertical_m.stddev = 0.5;
  const Place place{0.0, 0.0, 0.0, 0.0};
  const double metres_per_deg = 2.0 * std::numbers::pi * 6378137.0 / 360.0;
  const auto sample = [&](const MeasurementKey& key) {
    return measure_navsat(model, kTruth, place, key);
  };
  expect_spread(over_seeds(
                    [&](const auto& key) {
                      return sample(key).longitude_deg * metres_per_deg - kTruth.X_WS.p.x;
                    },
                    kLater),
                0.75, kStddev);
  expect_spread(
      over_seeds([&](const auto& key) { return sample(key).velocity_ENU_m_s.z - 3.0; }, kLater),
      0.75, kStddev);
  const uav::NavSatSample one = sample({0, "alpha", "gps", 0, kLater});
  EXPECT_NEAR(one.horizontal_accuracy_m, kStddev, 1e-12);
  EXPECT_EQ(one.vertical_accuracy_m, 0.5);
  EXPECT_EQ(one.speed_accuracy_m_s, 0.0);
}

// The walk is the same at nearby instants, and forgotten after many correlation times.
TEST(NavSat, TheDriftIsCorrelatedInTime) {
  NavSatModel model;
  model.horizontal_velocity_m_s = {0.0, 0.0, 0.0, 0.0, 1.0, 60.0};
  const auto error = [&](std::uint64_t seed, Duration at) {
    return measure_navsat(model, {}, {}, {seed, "a", "gps", 0, SimTime(at)}).velocity_ENU_m_s.x;
  };
  double same = 0.0, near = 0.0, far = 0.0;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const double e = error(seed, seconds(600));
    same += e * e;
    near += e * error(seed, seconds(615));
    far += e * error(seed, seconds(1200));
  }
  EXPECT_NEAR(near / same, std::exp(-15.0 / 60.0), 0.05);
  EXPECT_NEAR(far / same, 0.0, 0.08);
}

TEST(NavSat, AnOutageOfThatLengthBeginsInEachStretch) {
  NavSatModel model;
  model.outage_every_s = 30.0;
  model.outage_lasts_s = 4.0;
  std::vector<int> begins;
  for (int stretch = 0; stretch < 50; ++stretch) {
    int out = 0, changes = 0;
    bool was_out = false;
    for (int i = 0; i < 300; ++i) {
      const SimTime at{milliseconds(100) * (300 * stretch + i)};
      const bool is = is_out(model, {5, "alpha", "gps", 0, at});
      if (is && !was_out) begins.push_back(i);
      changes += is != was_out ? 1 : 0;
      out += is ? 1 : 0;
      was_out = is;
    }
    EXPECT_NEAR(out, 40, 1);
    EXPECT_LE(changes, 2) << "one outage";
  }
  EXPECT_GT(*std::ranges::max_element(begins) - *std::ranges::min_element(begins), 150);
  const uav::NavSatSample sample = measure_navsat(
      model, kTruth, {}, {5, "alpha", "gps", 9, SimTime(milliseconds(100) * begins.front())});
  EXPECT_FALSE(sample.has_fix);
  EXPECT_EQ(sample.index, 9U);
  EXPECT_TRUE(std::isnan(sample.latitude_deg) && std::isnan(sample.velocity_ENU_m_s.x));
}

TEST(Magnetometer, SeesTheFieldInItsOwnFrame) {
  const Vec3 field_W_T{1e-6, 2e-5, -4e-5};
  MagnetometerModel model;
  model.hard_iron_T = {3e-6, 0.0, 0.0};
  const auto got = measure_magnetometer(model, kTruth, field_W_T, {});
  EXPECT_LT(norm(rotate(kTruth.X_WS.q, got.field_T - model.hard_iron_T) - field_W_T), 1e-18);
  model.field_T.fill(kNoise);
  expect_spread(
      over_seeds(
          [&](const auto& key) { return measure_magnetometer(model, {}, {}, key).field_T.y; },
          kLater),
      0.75, kStddev);
}

TEST(Barometer, MeasuresTheStandardAtmosphereAboveThePlace) {
  const TrueMotion at_100_m{{{0.0, 0.0, 100.0}, {}}, {}, {}};
  EXPECT_NEAR(measure_barometer({}, at_100_m, {0.0, 0.0, 400.0, 0.0}, {}).altitude_m, 500.0, 1e-6);
  BarometerModel model;
  model.reference_altitude_m = 900.0;
  const auto got = measure_barometer(model, at_100_m, {0.0, 0.0, 400.0, 0.0}, {});
  EXPECT_NEAR(got.pressure_Pa, 89874.6, 1.0);
  model.pressure_Pa = kNoise;
  expect_spread(over_seeds(
                    [&](const auto& key) {
                      return measure_barometer(model, at_100_m, {}, key).pressure_Pa -
                             got.pressure_Pa;
                    },
                    kLater),
                0.75, kStddev);
}

TEST(Odometry, IsTheTruthWithoutNoise) {
  const uav::OdometrySample got = measure_odometry({}, kTruth, {1, "alpha", "odometry", 2, kLater});
  EXPECT_EQ(got.p_WS, kTruth.X_WS.p);
  EXPECT_EQ(got.q_WS, kTruth.X_WS.q);
  EXPECT_EQ(got.v_WS_m_s, kTruth.v_WS_W);
  EXPECT_EQ(got.w_WS_rad_s, kTruth.w_WS_S);
  EXPECT_EQ(got.position_stddev_m, Vec3{});
}

TEST(Odometry, ErrorsHaveTheSpreadThatItReports) {
  OdometryModel model;
  model.position_m = kNoise;
  model.yaw_rad = {0.0, 0.01, 0.0, 0.0, 0.0, 0.0};
  const auto sample = [&](const MeasurementKey& key) {
    return measure_odometry(model, kTruth, key);
  };
  expect_spread(over_seeds([&](const auto& key) { return sample(key).p_WS.y - 20.0; }, kLater),
                0.75, kStddev);
  const auto yaw_error = [&](const MeasurementKey& key) {
    return 2.0 * (sample(key).q_WS * inverse(kTruth.X_WS.q)).z;
  };
  expect_spread(over_seeds(yaw_error, kLater), 0.0, 0.01);
  const uav::OdometrySample one = sample({0, "alpha", "odometry", 0, kLater});
  EXPECT_NEAR(one.position_stddev_m.x, kStddev, 1e-12);
  EXPECT_EQ(one.attitude_stddev_rad, (Vec3{0.0, 0.0, 0.01}));
}

// With a long correlation time, the walk is that of dead reckoning: its variance grows with time.
TEST(Odometry, DriftsWithTheRootOfTime) {
  OdometryModel model;
  model.position_m = {0.0, 0.0, 0.0, 0.0, 0.1, 1e6};
  const auto error = [&](const MeasurementKey& key) {
    return measure_odometry(model, {}, key).p_WS.x;
  };
  for (const int at_s : {1, 25, 100})
    expect_spread(over_seeds(error, SimTime(seconds(at_s))), 0.0, 0.1 * std::sqrt(at_s));
}

}  // namespace
}  // namespace tether::sim
