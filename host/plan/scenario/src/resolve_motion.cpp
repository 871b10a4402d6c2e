#include "model_parts.h"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include <tether/base/text.h>
#include <tether/scenario/scenario.h>

namespace tether::scenario {
namespace {

[[noreturn]] void fail(const FileLocation& at, const std::string& table, const std::string& problem,
                       const std::string& about) {
  throw Error(ErrorCode::kBadFile, at, table + " " + problem).about(about);
}

void drive(const MovingModel& moving, sim::World& world) {
  const auto model = std::ranges::find(world.models, moving.model, &sim::Model::name);
  if (model == world.models.end()) {
    std::vector<std::string_view> names;
    for (const sim::Model& one : world.models) names.push_back(one.name);
    fail(moving.at, "[[moving]]",
         fmt::format("names the model '{}', which the world does not have; {}", moving.model,
                     allowed_hint(moving.model, names)),
         moving.model);
  }
  const uav::Vec3 p_WO = model->X_WM.p;
  for (sim::Model& part : world.models) {
    if (part.name != moving.model && !is_nested_in(part, moving.model)) continue;
    part.is_static = false;
    part.path = sim::DrivenPath{moving.path, p_WO};
  }
}

sim::Uav& carrier_of(const CarriedPayload& carried, sim::World& world) {
  std::vector<std::string_view> names;
  for (sim::Uav& uav : world.uavs) {
    names.push_back(uav.name);
    const bool is_only = carried.uav.empty() && world.uavs.size() == 1;
    if (uav.name == carried.uav || is_only) return uav;
  }
  fail(carried.at, "[[payload]]",
       carried.uav.empty() ? "does not name its UAV. Add 'uav', because there are several."
                           : fmt::format("names the UAV '{}', which the scenario does not have; {}",
                                         carried.uav, allowed_hint(carried.uav, names)),
       carried.uav);
}

/// With what it carries already when it picks this up.
void require_lift(const CarriedPayload& carried, sim::World& world, const sim::WarningSink& warn) {
  const sim::Uav& uav = carrier_of(carried, world);
  double load_kg = 0.0;
  for (const sim::Payload& payload : uav.payloads)
    if (payload.from <= carried.payload.from && carried.payload.from < payload.until)
      load_kg += payload.mass_kg;
  const std::string why = why_no_lift(uav, uav.airframe.mass_kg + load_kg, world);
  if (!why.empty()) fail(carried.at, "[[payload]]", why, "payload");
  const double held_kg = max_unknown_load_kg(uav.airframe, world.gravity_m_s2);
  if (warn && load_kg > held_kg)
    warn({Consequence::kDoubtful, carried.at, "[[payload]]",
          fmt::format("makes the UAV '{}' sink: it carries {:.3g} kg, and its controller, which "
                      "does not know of them, holds the height with at most {:.3g} kg",
                      uav.name, load_kg, held_kg)});
}

}  // namespace

void resolve_motion(const Scenario& scenario, bool is_read_elsewhere, sim::World& world) {
  const auto refuse = [](const FileLocation& at, const std::string& table) {
    fail(at, table,
         "needs the embedded simulator: an external one reads the world's file itself, and is not "
         "told of this",
         table);
  };
  if (scenario.wind) {
    if (is_read_elsewhere) refuse(scenario.wind_at, "[wind]");
    world.wind = *scenario.wind;
  }
  for (const MovingModel& moving : scenario.moving) {
    if (is_read_elsewhere) refuse(moving.at, "[[moving]]");
    drive(moving, world);
  }
  for (const CarriedPayload& carried : scenario.payloads) {
    if (is_read_elsewhere) refuse(carried.at, "[[payload]]");
    carrier_of(carried, world).payloads.push_back(carried.payload);
  }
}

Resolved resolve_world(const Scenario& scenario, const Condition& condition, std::uint64_t seed,
                       bool is_read_elsewhere, sim::World& world, const sim::WarningSink& warn) {
  Resolved resolved;
  resolve_motion(scenario, is_read_elsewhere, world);
  resolved.varied = vary(scenario.variations, seed, is_read_elsewhere, world);
  for (const CarriedPayload& carried : scenario.payloads) require_lift(carried, world, warn);
  resolve_step(scenario, world);
  resolve_energy(scenario, condition, world, warn);
  resolved.timings = resolve_sensors(scenario, condition, world, warn);
  vary_mountings(scenario.variations, resolved.varied, world);
  std::ranges::copy(start_yaws(scenario, seed), std::back_inserter(resolved.varied));
  return resolved;
}

}  // namespace tether::scenario
