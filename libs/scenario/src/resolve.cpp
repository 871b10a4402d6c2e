#include "suggest.h"

#include <algorithm>

#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/base/random.h>
#include <tether/scenario/scenario.h>

namespace tether::scenario {
namespace {

uav::SensorTiming default_timing(const sim::Sensor& sensor) {
  if (sensor.update_rate_hz <= 0.0) return uav::OnDemandTiming{};
  uav::PeriodicTiming timing;
  timing.period = duration_from_seconds(1.0 / sensor.update_rate_hz);
  return timing;
}

void require_sensors_exist(const Scenario& scenario, const UavSetup& setup, const sim::Uav& uav) {
  std::vector<std::string_view> names;
  for (const sim::Sensor& sensor : uav.sensors) names.push_back(sensor.name);
  const auto require = [&](const std::string& name, int line) {
    if (std::find(names.begin(), names.end(), name) != names.end()) return;
    throw Error(ErrorCode::kBadFile, FileLocation{scenario.file.string(), line},
                fmt::format("the UAV '{}' has no sensor '{}' ({}); {}", uav.name, name,
                            setup.placement.model.string(), allowed_hint(name, names)));
  };
  for (const auto& [name, sensor] : setup.sensors) require(name, sensor.line);
  for (const Metric& metric : scenario.metrics) {
    if (metric.uav == uav.name && !metric.sensor.empty()) require(metric.sensor, metric.line);
  }
}

std::vector<uav::SensorTiming> timings_of(const UavSetup& setup, const sim::Uav& uav) {
  std::vector<uav::SensorTiming> timings;
  for (const sim::Sensor& sensor : uav.sensors) {
    const auto found = setup.sensors.find(sensor.name);
    timings.push_back(found == setup.sensors.end() ? default_timing(sensor) : found->second.timing);
  }
  return timings;
}

const UavSetup& setup_of(const Scenario& scenario, const std::string& uav) {
  for (const UavSetup& setup : scenario.uavs) {
    if (setup.placement.name == uav) return setup;
  }
  throw Error(ErrorCode::kInternal,
              fmt::format("the world has a UAV '{}' that its scenario does not know", uav));
}

}  // namespace

sim::WorldRequest world_request(const Scenario& scenario, std::uint64_t seed) {
  sim::WorldRequest request;
  request.world = scenario.world;
  for (const UavSetup& uav : scenario.uavs) {
    KeyedRandom random({seed, random_stream(uav.placement.name, "", "start yaw"), 0});
    request.uavs.push_back(uav.placement);
    request.uavs.back().yaw_rad += uav.yaw_spread_rad * (2.0 * random.uniform() - 1.0);
  }
  request.anchors = scenario.anchors;
  return request;
}

std::vector<std::vector<uav::SensorTiming>> resolve_timings(const Scenario& scenario,
                                                            const sim::World& world) {
  std::vector<std::vector<uav::SensorTiming>> timings;
  for (const sim::Uav& uav : world.uavs) {
    const UavSetup& setup = setup_of(scenario, uav.name);
    require_sensors_exist(scenario, setup, uav);
    timings.push_back(timings_of(setup, uav));
  }
  return timings;
}

}  // namespace tether::scenario
