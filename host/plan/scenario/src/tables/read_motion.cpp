#include "tables/read_motion.h"

#include <set>

#include <fmt/format.h>

#include <tether/base/units.h>

namespace tether::scenario {
namespace {

constexpr toml::Range kOffset_m{.min = -1e5, .max = 1e5};

uav::Vec3 read_vec3(const toml::Table& table, std::string_view key, const toml::Range& range) {
  const std::vector<double> v = table.numbers(key, 3, range);
  return {v[0], v[1], v[2]};
}

uav::Wind read_wind(const toml::Table& table) {
  constexpr toml::Range kSpeed_m_s{.min = -60.0, .max = 60.0};
  constexpr toml::Range kRoughness_m{.min = 0.0, .max = 3.0};
  constexpr toml::Range kTurbulence{.min = 0.0, .max = 10.0};
  uav::Wind wind;
  wind.v_WA_m_s = read_vec3(table, "velocity_m_s", kSpeed_m_s);
  wind.roughness_m = table.number_or("roughness_m", kRoughness_m, 0.0);
  wind.turbulence = table.number_or("turbulence", kTurbulence, 0.0);
  if (wind.turbulence > 0.0 && wind.v_WA_m_s.x == 0.0 && wind.v_WA_m_s.y == 0.0)
    table.fail("turbulence",
               "has no effect without a wind along the ground, on which the gusts depend. Set "
               "'velocity_m_s', or remove this key.");
  return wind;
}

CarriedPayload read_payload(const toml::Table& table, Duration time_limit) {
  constexpr toml::Range kMass_kg{.min = 0.0, .max = 100.0, .above_min = true};
  constexpr toml::Range kAt_s{.min = 0.0, .max = kLongestRun_s};
  CarriedPayload carried{.uav = table.text_or("uav", ""), .payload = {}, .at = table.where()};
  carried.payload.mass_kg = table.number("mass_kg", kMass_kg);
  if (table.has("from_s")) carried.payload.from = SimTime(table.duration("from_s", kAt_s));
  if (table.has("until_s")) carried.payload.until = SimTime(table.duration("until_s", kAt_s));
  if (carried.payload.until <= carried.payload.from)
    table.fail("until_s", fmt::format("must be later than 'from_s', which is {:g}{}.",
                                      to_seconds(carried.payload.from),
                                      table.has("from_s") ? "" : " by default"));
  if (carried.payload.from >= SimTime(time_limit))
    table.fail("from_s", fmt::format("is {:.6g}, but the flight ends at 'time_limit_s' = {:.6g}.",
                                     to_seconds(carried.payload.from), to_seconds(time_limit)));
  return carried;
}

MovingModel read_moving(const toml::Table& table) {
  constexpr toml::Range kAt_s{.min = 0.0, .max = kLongestRun_s};
  constexpr toml::Range kYaw_deg{.min = -36'000.0, .max = 36'000.0};
  MovingModel moving{.model = table.text("model"), .path = {}, .at = table.where()};
  moving.path.repeats = table.boolean_or("repeats", false);
  for (const toml::Table& point : table.tables("waypoint", {"at_s", "offset_m", "yaw_deg"}))
    moving.path.waypoints.push_back({point.duration("at_s", kAt_s),
                                     read_vec3(point, "offset_m", kOffset_m),
                                     rad_from_deg(point.number_or("yaw_deg", kYaw_deg, 0.0))});
  if (const std::string wrong = complaint_about(moving.path); !wrong.empty())
    table.fail("waypoint", wrong + ".");
  return moving;
}

}  // namespace

void read_motion(const toml::Table& root, Scenario& scenario) {
  if (root.has("wind")) {
    const toml::Table table = root.table("wind", {"velocity_m_s", "roughness_m", "turbulence"});
    scenario.wind = read_wind(table);
    scenario.wind_at = table.where();
  }
  for (const toml::Table& table :
       root.tables_or_none("payload", {"uav", "mass_kg", "from_s", "until_s"}))
    scenario.payloads.push_back(read_payload(table, scenario.time_limit));
  std::set<std::string> names;
  for (const toml::Table& table : root.tables_or_none("moving", {"model", "repeats", "waypoint"})) {
    scenario.moving.push_back(read_moving(table));
    if (!names.insert(scenario.moving.back().model).second)
      table.fail("model", "moves in another [[moving]] already. Remove one.");
  }
}

}  // namespace tether::scenario
