#include <cmath>

#include <gtest/gtest.h>

#include <tether/radio/medium.h>

namespace tether::radio {
namespace {

TEST(LinkBudget, PathLossGrowsByTheExponentAndByWalls) {
  Settings settings;
  settings.reference_loss_db = 40.0;
  settings.exponent = 3.0;
  settings.wall_loss_db = 6.0;
  EXPECT_DOUBLE_EQ(path_loss_db(settings, {.distance_m = 1.0}, 0.0), 40.0);
  EXPECT_DOUBLE_EQ(path_loss_db(settings, {.distance_m = 100.0}, 0.0), 100.0);
  EXPECT_DOUBLE_EQ(path_loss_db(settings, {.distance_m = 100.0, .walls = 2}, -1.5), 110.5);
  EXPECT_DOUBLE_EQ(path_loss_db(settings, {.distance_m = 0.0}, 0.0), 40.0) << "never a gain";
}

TEST(LinkBudget, NoiseIsThermalAndTheReceivers) {
  Settings settings;
  settings.bandwidth_hz = 20e6;
  settings.noise_figure_db = 7.0;
  EXPECT_NEAR(noise_dbm(settings), -93.99, 0.01);
}

// The curve of the textbooks: 1e-5 at 9.59 dB.
TEST(LinkBudget, BitErrorsAreThoseOfBpsk) {
  Settings settings;
  settings.bandwidth_hz = settings.data_rate_bit_s = 1e6;
  EXPECT_NEAR(bit_error_rate(settings, 9.59), 1e-5, 2e-7);
  EXPECT_NEAR(bit_error_rate(settings, 0.0), 0.0786, 1e-4);
  settings.bandwidth_hz = 10e6;
  EXPECT_NEAR(bit_error_rate(settings, -10.0), 0.0786, 1e-4) << "Eb/N0 is SNR × B / R";
}

TEST(LinkBudget, LossGrowsWithDistanceWallsAndLength) {
  const Settings settings;
  const auto loss = [&](double distance_m, int walls, std::size_t bytes) {
    const double snr = settings.tx_power_dbm - path_loss_db(settings, {distance_m, walls}, 0.0) -
                       noise_dbm(settings);
    return loss_probability(settings, snr, bytes);
  };
  double last = 0.0;
  for (double distance_m = 1.0; distance_m < 1e5; distance_m *= 1.2) {
    const double now = loss(distance_m, 0, 100);
    EXPECT_GE(now, last) << distance_m;
    EXPECT_GE(loss(distance_m, 1, 100), now);
    EXPECT_GE(loss(distance_m, 0, 1000), now);
    last = now;
  }
  EXPECT_LT(loss(1.0, 0, 100), 1e-12);
  EXPECT_GT(last, 0.999);
}

TEST(LinkBudget, AirTimeIsPreambleAndBits) {
  Settings settings;
  settings.preamble = Duration(20'000);
  settings.header_bytes = 36;
  settings.data_rate_bit_s = 6e6;
  EXPECT_EQ(air_time(settings, 64), Duration(20'000 + 133'334));
  settings.model = Model::kLogDistance;
  settings.delay = Duration(5);
  EXPECT_EQ(least_delay(settings), Duration(5) + air_time(settings, 0));
  settings.model = Model::kIdeal;
  EXPECT_EQ(least_delay(settings), Duration(5));
}

}  // namespace
}  // namespace tether::radio
