#include "model_parts.h"
#include "quantity.h"

#include <algorithm>
#include <functional>
#include <set>

#include <fmt/format.h>

#include <tether/base/random.h>
#include <tether/base/text.h>
#include <tether/scenario/scenario.h>
#include <tether/sim/bodies.h>
#include <tether/sim/contacts.h>

namespace tether::scenario {
namespace {

bool is_of_world(Part part) {
  return part == Part::kWorld || part == Part::kWind;
}

const Quantity& quantity_of(const Variation& variation) {
  return *std::ranges::find(quantities(), variation.quantity, &Quantity::name);
}

[[noreturn]] void fail(const Variation& variation, const std::string& problem) {
  throw Error(ErrorCode::kBadFile, variation.at,
              fmt::format("[vary.{}] {}", variation.name, problem))
      .about(variation.name);
}

template <class Named>
Named& find(std::vector<Named>& all, const std::string& name, const Variation& variation,
            std::string_view kind) {
  const auto found = std::ranges::find(all, name, &Named::name);
  if (found != all.end()) return *found;
  std::vector<std::string_view> names;
  for (const Named& one : all) names.push_back(one.name);
  fail(variation, fmt::format("varies {} '{}', which does not exist; {}", kind, name,
                              allowed_hint(name, names)));
}

double draw(const Distribution& distribution, KeyedRandom& random) {
  if (const auto* uniform = std::get_if<Uniform>(&distribution))
    return uniform->least + (uniform->most - uniform->least) * random.uniform();
  if (const auto* normal = std::get_if<Normal>(&distribution))
    return normal->mean + normal->stddev * random.normal();
  const std::vector<double>& values = std::get<OneOf>(distribution).values;
  return values[static_cast<std::size_t>(random.uniform() * static_cast<double>(values.size()))];
}

/// `attempt`: each gives another value.
Varied value_of(const Variation& variation, std::uint64_t seed, std::uint64_t attempt) {
  KeyedRandom random({seed, random_stream(variation.name, "", "vary"), attempt});
  const double value = draw(variation.distribution, random);
  const toml::Range& allowed = quantity_of(variation).allowed;
  if (!allowed.contains(value))
    fail(variation,
         fmt::format("gives {:.6g}, but {} must be {}", value, variation.quantity, allowed.text()));
  return {variation.name, variation.text(), value};
}

/// Of a model and those that are nested in it.
void change_paths(const Variation& variation, double value, sim::World& world) {
  if (!find(world.models, variation.of, variation, "the model").path)
    fail(variation, fmt::format("varies the path of the model '{}', which has none. Give it one "
                                "with [[moving]]",
                                variation.of));
  for (sim::Model& model : world.models)
    if (model.path && (model.name == variation.of || is_nested_in(model, variation.of))) {
      quantity_of(variation).change(world, nullptr, &model, nullptr, value);
      if (const std::string wrong = complaint_about(*model.path); !wrong.empty())
        fail(variation, fmt::format("gives {:.6g}: the path of '{}' {}", value, model.name, wrong));
    }
}

/// With the model or UAV of that name.
void place_anchor(const std::string& name, const uav::Pose& now, const uav::Pose& before,
                  sim::World& world) {
  for (sim::PlacedAnchor& placed : world.anchors)
    if (placed.anchor.name == name) placed.X_WA = now * (uav::inverse(before) * placed.X_WA);
}

/// The UAVs that it is about.
std::vector<sim::Uav*> uavs_of(const Variation& variation, sim::World& world) {
  if (!variation.of.empty()) return {&find(world.uavs, variation.of, variation, "the UAV")};
  std::vector<sim::Uav*> uavs;
  for (sim::Uav& uav : world.uavs) uavs.push_back(&uav);
  return uavs;
}

void change_uavs(const Variation& variation, double value, sim::World& world) {
  for (sim::Uav* uav : uavs_of(variation, world)) {
    quantity_of(variation).change(world, uav, nullptr, nullptr, value);
    if (uav->airframe.mass_kg <= 0.0)
      fail(variation,
           fmt::format("gives the UAV '{}' a mass of {:.6g} kg", uav->name, uav->airframe.mass_kg));
  }
}

/// When all of it is changed.
void require_lift(const Variation& variation, sim::World& world) {
  for (const sim::Uav* uav : uavs_of(variation, world))
    if (const std::string why = why_no_lift(*uav, uav->airframe.mass_kg, world); !why.empty())
      fail(variation, why);
}

void require_wind(const Variation& variation, const uav::Wind& wind) {
  if (wind.is_calm())
    fail(variation,
         "varies the wind, but there is none. Give the scenario a table [wind] whose velocity_m_s "
         "is not zero");
  if (variation.quantity == "turbulence_factor" && wind.turbulence == 0.0)
    fail(variation,
         "varies the turbulence, but there is none. Give the scenario's [wind] a 'turbulence'");
}

// --- places --------------------------------------------------------------------------------------

/// All that is varied of one place at once: its coordinates are not independent of each other.
using Group = std::vector<const Variation*>;

/// Draws again until the place is free: `try_values` says whether it is.
void draw_place(const Group& group, const std::string& what, std::uint64_t seed,
                std::vector<Varied>& values,
                const std::function<bool(const std::vector<Varied>&)>& try_values) {
  constexpr std::uint64_t kAttempts = 100;
  for (std::uint64_t attempt = 0; attempt < kAttempts; ++attempt) {
    std::vector<Varied> drawn;
    for (const Variation* variation : group) drawn.push_back(value_of(*variation, seed, attempt));
    if (!try_values(drawn)) continue;
    values.insert(values.end(), drawn.begin(), drawn.end());
    return;
  }
  fail(*group.front(), fmt::format("finds no place for {} with seed {}, in which it touches "
                                   "nothing else. Give it more room",
                                   what, seed));
}

/// What each UAV starts inside of, or below; empty: nothing. Meshes are not looked at.
std::vector<std::string> obstacles_of_starts(sim::World world) {
  const auto leave_out_meshes = [](sim::Link& link) {
    std::erase_if(link.collisions, [](const sim::Collision& collision) {
      return std::holds_alternative<sim::MeshGeometry>(collision.geometry);
    });
  };
  for (sim::Uav& uav : world.uavs) leave_out_meshes(uav.body);
  for (sim::Model& model : world.models) std::ranges::for_each(model.links, leave_out_meshes);
  const sim::ClearanceMeter meter(world, {});
  std::vector<std::string> obstacles;
  for (std::size_t i = 0; i < world.uavs.size(); ++i)
    obstacles.emplace_back(meter.obstacle_of_start(i));
  return obstacles;
}

void place_uavs(const Group& group, std::uint64_t seed, sim::World& world,
                std::vector<Varied>& values) {
  const std::vector<sim::Uav*> uavs = uavs_of(*group.front(), world);
  std::vector<uav::Pose> before;
  for (const sim::Uav* uav : uavs) before.push_back(uav->X_WB);
  const std::vector<std::string> in_the_file = obstacles_of_starts(world);
  const auto is_free = [&](const std::vector<std::string>& obstacles) {
    return std::ranges::equal(obstacles, in_the_file, [](const auto& now, const auto& known) {
      return now.empty() || now == known;
    });
  };
  const std::string what =
      uavs.size() == 1 ? fmt::format("the UAV '{}'", uavs[0]->name) : "the UAVs";
  draw_place(group, what, seed, values, [&](const std::vector<Varied>& drawn) {
    for (std::size_t i = 0; i < uavs.size(); ++i) {
      uavs[i]->X_WB = before[i];
      for (std::size_t k = 0; k < group.size(); ++k)
        quantity_of(*group[k]).change(world, uavs[i], nullptr, nullptr, drawn[k].value);
    }
    return is_free(obstacles_of_starts(world));
  });
  for (std::size_t i = 0; i < uavs.size(); ++i)
    place_anchor(uavs[i]->name, uavs[i]->X_WB, before[i], world);
}

/// The names of what touches a model, UAVs included: of each link by itself, as the meter measures
/// distances from UAVs.
std::set<std::string> touching(const sim::World& world, const sim::Model& model) {
  std::set<std::string> names;
  const auto look = [&](const std::string& name, const auto& add_other) {
    for (const sim::Link& link : model.links) {
      sim::World pair;
      sim::Uav as_uav;
      as_uav.body = link;
      as_uav.X_WB = start_of(model, link);
      pair.uavs.push_back(std::move(as_uav));
      add_other(pair);
      std::vector<uav::Pose> X_WB;
      for (const sim::MovingBody& body : moving_bodies(pair)) X_WB.push_back(body.X_WB);
      const auto clearance = sim::ClearanceMeter(pair, {}).measure(0, X_WB);
      if (clearance && clearance->distance_m <= 0.0) names.insert(name);
    }
  };
  for (const sim::Model& other : world.models)
    if (other.name != model.name)
      look(other.name, [&](sim::World& pair) { pair.models.push_back(other); });
  for (const sim::Uav& uav : world.uavs)
    look(uav.name, [&](sim::World& pair) { pair.uavs.push_back(uav); });
  return names;
}

/// Those that are nested in a model stay in their places of it.
void move_nested(sim::Model& model, const uav::Pose& X_WM_before, sim::World& world) {
  const uav::Pose moved = model.X_WM * uav::inverse(X_WM_before);
  if (model.path) model.path->p_WO = transform(moved, model.path->p_WO);
  for (sim::Model& part : world.models) {
    if (!is_nested_in(part, model.name)) continue;
    const uav::Pose before = part.X_WM;
    part.X_WM = model.X_WM * (uav::inverse(X_WM_before) * before);
    if (part.path) part.path->p_WO = transform(moved, part.path->p_WO);
    place_anchor(part.name, part.X_WM, before, world);
  }
}

void place_model(const Group& group, std::uint64_t seed, sim::World& world,
                 std::vector<Varied>& values) {
  const Variation& first = *group.front();
  sim::Model& model = find(world.models, first.of, first, "the model");
  const sim::Model before = model;
  const std::set<std::string> allowed = touching(world, before);
  const std::string what = fmt::format("the model '{}'", model.name);
  draw_place(group, what, seed, values, [&](const std::vector<Varied>& drawn) {
    model = before;
    for (std::size_t k = 0; k < group.size(); ++k)
      quantity_of(*group[k]).change(world, nullptr, &model, nullptr, drawn[k].value);
    return std::ranges::includes(allowed, touching(world, model));
  });
  place_anchor(model.name, model.X_WM, before.X_WM, world);
  move_nested(model, before.X_WM, world);
}

/// The variations of this part, by what they are of.
std::vector<Group> groups(const std::vector<Variation>& variations, Part part) {
  std::vector<Group> groups;
  for (const Variation& variation : variations) {
    if (quantity_of(variation).part != part) continue;
    const auto known = std::ranges::find(groups, variation.of,
                                         [](const Group& group) { return group.front()->of; });
    if (known != groups.end())
      known->push_back(&variation);
    else
      groups.push_back({&variation});
  }
  return groups;
}

}  // namespace

std::string Variation::text() const {
  return of.empty() ? quantity : fmt::format("{} of {}", quantity, of);
}

// Models come last: they make room for the UAVs.
std::vector<Varied> vary(const std::vector<Variation>& variations, std::uint64_t seed,
                         bool is_read_elsewhere, sim::World& world) {
  std::vector<Varied> values;
  for (const Variation& variation : variations) {
    const Part part = quantity_of(variation).part;
    const bool is_seen = part == Part::kStart || part == Part::kUav || part == Part::kSensor;
    if (is_read_elsewhere && !is_seen)
      fail(variation,
           fmt::format("varies {}, but this simulator reads the world's file itself. Use "
                       "the embedded simulator, or vary UAVs and sensors only",
                       variation.text()));
    if (part == Part::kWind) require_wind(variation, world.wind);
    if (part == Part::kStart || part == Part::kModel) continue;
    values.push_back(value_of(variation, seed, 0));
    if (part == Part::kUav) change_uavs(variation, values.back().value, world);
    if (part == Part::kPath) change_paths(variation, values.back().value, world);
    if (is_of_world(part))
      quantity_of(variation).change(world, nullptr, nullptr, nullptr, values.back().value);
  }
  for (const Variation& variation : variations)
    if (quantity_of(variation).part == Part::kUav) require_lift(variation, world);
  for (const Group& group : groups(variations, Part::kStart))
    place_uavs(group, seed, world, values);
  for (const Group& group : groups(variations, Part::kModel))
    place_model(group, seed, world, values);
  return values;
}

void vary_mountings(const std::vector<Variation>& variations, const std::vector<Varied>& values,
                    sim::World& world) {
  for (const Variation& variation : variations) {
    const Quantity& quantity = quantity_of(variation);
    if (quantity.part != Part::kSensor) continue;
    const double value = std::ranges::find(values, variation.name, &Varied::name)->value;
    const std::size_t dot = variation.of.rfind('.');
    if (dot == std::string::npos)
      fail(variation, fmt::format("varies a sensor, so 'of' must be \"UAV.SENSOR\", but is \"{}\"",
                                  variation.of));
    sim::Uav& uav = find(world.uavs, variation.of.substr(0, dot), variation, "the UAV");
    sim::Sensor& sensor = find(uav.sensors, variation.of.substr(dot + 1), variation, "the sensor");
    quantity.change(world, nullptr, nullptr, &sensor, value);
  }
}

}  // namespace tether::scenario
