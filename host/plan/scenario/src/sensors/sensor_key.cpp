#include "sensors/sensor_key.h"

#include <array>

#include <fmt/format.h>

namespace tether::scenario {
namespace {

template <class... Models>
std::array<std::vector<SensorKey>, sizeof...(Models)> rows(
    std::type_identity<std::variant<Models...>>) {
  return {keys_of(std::type_identity<Models>{})...};
}

}  // namespace

const std::vector<SensorKey>& keys_of(uav::SensorKind kind) {
  static const auto all = rows(std::type_identity<decltype(sim::Sensor::model)>{});
  return all.at(static_cast<std::size_t>(kind));
}

sim::Noise noise(const toml::Table& table, std::string_view key) {
  constexpr toml::Range kMean{.min = -1e6, .max = 1e6};
  constexpr toml::Range kSpread{.min = 0.0, .max = 1e6};
  const toml::Table given =
      table.table(key, {"mean", "stddev", "bias_mean", "bias_stddev", "dynamic_bias_stddev",
                        "dynamic_bias_correlation_time_s"});
  sim::Noise noise;
  noise.mean = given.number_or("mean", kMean, 0.0);
  noise.stddev = given.number_or("stddev", kSpread, 0.0);
  noise.bias_mean = given.number_or("bias_mean", kMean, 0.0);
  noise.bias_stddev = given.number_or("bias_stddev", kSpread, 0.0);
  noise.dynamic_bias_stddev = given.number_or("dynamic_bias_stddev", kSpread, 0.0);
  noise.dynamic_bias_correlation_time_s =
      given.number_or("dynamic_bias_correlation_time_s", kSpread, 0.0);
  if (noise.dynamic_bias_stddev > 0.0 && noise.dynamic_bias_correlation_time_s == 0.0) {
    given.fail("dynamic_bias_correlation_time_s",
               "must be greater than 0, because 'dynamic_bias_stddev' is.");
  }
  return noise;
}

FileLocation Laid::at(std::initializer_list<std::string_view> keys) const {
  for (auto layer = layers_.rbegin(); layer != layers_.rend(); ++layer) {
    for (const std::string_view key : keys)
      if ((*layer)->lines.contains(key)) return (*layer)->at(key);
  }
  return {};
}

void Finished::unfit(std::string_view key, std::string_view reason) const {
  throw Error(ErrorCode::kBadFile, laid.at({key}),
              fmt::format("'{}' does not fit the sensor '{}', because {}", key, name, reason))
      .about(std::string(key));
}

void Finished::refuse(std::initializer_list<std::string_view> keys,
                      const std::string& problem) const {
  throw Error(ErrorCode::kBadFile, laid.at(keys), fmt::format("the sensor '{}' {}", name, problem))
      .about(name);
}

void Finished::check_limits(double min_m, double max_m) const {
  if (min_m < max_m) return;
  refuse({"min_m", "max_m"},
         fmt::format("has min_m = {:.6g} and max_m = {:.6g}. min_m must be less than max_m.", min_m,
                     max_m));
}

}  // namespace tether::scenario
