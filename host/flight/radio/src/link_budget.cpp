#include <algorithm>
#include <cmath>

#include <tether/radio/medium.h>

namespace tether::radio {
namespace {

double linear(double db) {
  return std::pow(10.0, db / 10.0);
}

}  // namespace

double path_loss_db(const Settings& settings, const Link& link, double shadowing_db) {
  return settings.reference_loss_db +
         10.0 * settings.exponent * std::log10(std::max(link.distance_m, 1.0)) + shadowing_db +
         link.walls * settings.wall_loss_db;
}

double noise_dbm(const Settings& settings) {
  constexpr double kThermal_dbm_hz = -174.0;
  return kThermal_dbm_hz + 10.0 * std::log10(settings.bandwidth_hz) + settings.noise_figure_db;
}

double bit_error_rate(const Settings& settings, double snr_db) {
  const double eb_n0 = linear(snr_db) * settings.bandwidth_hz / settings.data_rate_bit_s;
  return 0.5 * std::erfc(std::sqrt(eb_n0));
}

double loss_probability(const Settings& settings, double snr_db, std::size_t bytes) {
  const auto bits = static_cast<double>(8 * (bytes + settings.header_bytes));
  return -std::expm1(bits * std::log1p(-bit_error_rate(settings, snr_db)));
}

Duration air_time(const Settings& settings, std::size_t bytes) {
  const auto bits = static_cast<double>(8 * (bytes + settings.header_bytes));
  const double data_ns = std::ceil(bits / settings.data_rate_bit_s * 1e9);
  return settings.preamble + Duration(static_cast<std::int64_t>(data_ns));
}

Duration least_delay(const Settings& settings) {
  if (settings.model == Model::kIdeal) return settings.delay;
  if (settings.model == Model::kDistribution)
    return settings.delay + uav::bounds(settings.drawn_delay).first;
  return settings.delay + air_time(settings, 0);
}

double sum_dbm(double a_dbm, double b_dbm) {
  return 10.0 * std::log10(linear(a_dbm) + linear(b_dbm));
}

}  // namespace tether::radio
