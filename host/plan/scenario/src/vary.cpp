// Quantities are rows of a table: which part of the world they belong to, and how a value changes
// it. Positions and angles are added to those of the files; factors multiply. A UAV's controller
// knows its mass and its rotors, as that of a real one is tuned to them.

#include "model_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <set>

#include <fmt/format.h>

#include <tether/base/random.h>
#include <tether/base/suggest.h>
#include <tether/base/units.h>
#include <tether/scenario/scenario.h>
#include <tether/sim/bodies.h>
#include <tether/sim/clearance.h>

namespace tether::scenario {
namespace {

/// kWind: of a world with wind. kPath: of a model with a path.
enum class Part { kUav, kModel, kPath, kWorld, kWind, kSensor };
bool is_of_world(Part part) {
  return part == Part::kWorld || part == Part::kWind;
}

struct Quantity {
  std::string_view name;
  Part part;
  bool is_factor;  ///< must be above 0
  void (*change)(sim::World& world, sim::Uav* uav, sim::Model* model, sim::Sensor* sensor,
                 double value);
};

using Change = decltype(Quantity::change);

template <auto Member>
constexpr Change kMoveUav = [](sim::World&, sim::Uav* uav, sim::Model*, sim::Sensor*,
                               double value) { uav->X_WB.p.*Member += value; };
template <auto Member>
constexpr Change kMoveModel = [](sim::World&, sim::Uav*, sim::Model* model, sim::Sensor*,
                                 double value) { model->X_WM.p.*Member += value; };
template <auto Member>
constexpr Change kMoveSensor = [](sim::World&, sim::Uav*, sim::Model*, sim::Sensor* sensor,
                                  double value) { sensor->X_BS.p.*Member += value; };

uav::Quat turn(double roll_deg, double pitch_deg, double yaw_deg) {
  return uav::from_rpy(rad_from_deg(roll_deg), rad_from_deg(pitch_deg), rad_from_deg(yaw_deg));
}

void scale_mass(sim::Uav& uav, double mass_kg) {
  const double factor = mass_kg / uav.airframe.mass_kg;
  uav.airframe.mass_kg = mass_kg;
  uav.airframe.inertia_kg_m2 = factor * uav.airframe.inertia_kg_m2;
  uav.body.mass_kg *= factor;
  uav.body.inertia_kg_m2 = factor * uav.body.inertia_kg_m2;
}

void for_each_collision(sim::World& world, const std::function<void(sim::Collision&)>& change) {
  for (sim::Model& model : world.models)
    for (sim::Link& link : model.links)
      for (sim::Collision& collision : link.collisions) change(collision);
}

using uav::Vec3;

void for_each_colour(sim::Model& model, const std::function<void(Vec3&)>& change) {
  for (sim::Link& link : model.links)
    for (sim::Visual& visual : link.visuals) {
      change(visual.material.diffuse_rgb);
      change(visual.material.ambient_rgb);
    }
}

void for_each_light(sim::World& world, const std::function<void(Vec3&)>& change) {
  change(world.ambient_rgb);
  for (sim::Light& light : world.lights) {
    change(light.diffuse_rgb);
    change(light.specular_rgb);
  }
}

Vec3 grey_of(const Vec3& rgb) {
  const double mean = (rgb.x + rgb.y + rgb.z) / 3.0;
  return {mean, mean, mean};
}

Vec3 within_colours(const Vec3& rgb) {
  return {std::clamp(rgb.x, 0.0, 1.0), std::clamp(rgb.y, 0.0, 1.0), std::clamp(rgb.z, 0.0, 1.0)};
}

/// About the axis of the greys: from red over green to blue.
Vec3 turned_hue(const Vec3& rgb, double hue_deg) {
  const double third = std::sqrt(1.0 / 3.0);
  return within_colours(
      rotate(uav::from_axis_angle({third, third, third}, rad_from_deg(hue_deg)), rgb));
}

constexpr std::array kQuantities = {
    Quantity{"start_x_m", Part::kUav, false, kMoveUav<&Vec3::x>},
    Quantity{"start_y_m", Part::kUav, false, kMoveUav<&Vec3::y>},
    Quantity{"start_z_m", Part::kUav, false, kMoveUav<&Vec3::z>},
    Quantity{"start_yaw_deg", Part::kUav, false,
             [](sim::World&, sim::Uav* uav, sim::Model*, sim::Sensor*, double yaw_deg) {
               uav->X_WB.q = turn(0.0, 0.0, yaw_deg) * uav->X_WB.q;
             }},
    Quantity{"mass_factor", Part::kUav, true,
             [](sim::World&, sim::Uav* uav, sim::Model*, sim::Sensor*, double factor) {
               scale_mass(*uav, factor * uav->airframe.mass_kg);
             }},
    Quantity{"payload_kg", Part::kUav, false,
             [](sim::World&, sim::Uav* uav, sim::Model*, sim::Sensor*, double payload_kg) {
               scale_mass(*uav, uav->airframe.mass_kg + payload_kg);
             }},
    Quantity{"thrust_factor", Part::kUav, true,
             [](sim::World&, sim::Uav* uav, sim::Model*, sim::Sensor*, double factor) {
               uav->airframe.thrust_coefficient *= factor;
             }},
    Quantity{"drag_factor", Part::kUav, true,
             [](sim::World&, sim::Uav* uav, sim::Model*, sim::Sensor*, double factor) {
               uav->airframe.drag_coefficient *= factor;
               uav->airframe.linear_drag_N_s_m *= factor;
             }},
    Quantity{"motor_lag_factor", Part::kUav, true,
             [](sim::World&, sim::Uav* uav, sim::Model*, sim::Sensor*, double factor) {
               uav->airframe.time_constant_up_s *= factor;
               uav->airframe.time_constant_down_s *= factor;
             }},
    Quantity{"model_x_m", Part::kModel, false, kMoveModel<&Vec3::x>},
    Quantity{"model_y_m", Part::kModel, false, kMoveModel<&Vec3::y>},
    Quantity{"model_z_m", Part::kModel, false, kMoveModel<&Vec3::z>},
    Quantity{"model_yaw_deg", Part::kModel, false,
             [](sim::World&, sim::Uav*, sim::Model* model, sim::Sensor*, double yaw_deg) {
               model->X_WM.q = turn(0.0, 0.0, yaw_deg) * model->X_WM.q;
             }},
    Quantity{"model_brightness_factor", Part::kModel, true,
             [](sim::World&, sim::Uav*, sim::Model* model, sim::Sensor*, double factor) {
               for_each_colour(*model, [&](Vec3& rgb) { rgb = factor * rgb; });
             }},
    Quantity{"model_hue_deg", Part::kModel, false,
             [](sim::World&, sim::Uav*, sim::Model* model, sim::Sensor*, double hue_deg) {
               for_each_colour(*model, [&](Vec3& rgb) { rgb = turned_hue(rgb, hue_deg); });
             }},
    Quantity{"model_saturation_factor", Part::kModel, true,
             [](sim::World&, sim::Uav*, sim::Model* model, sim::Sensor*, double factor) {
               for_each_colour(*model, [&](Vec3& rgb) {
                 rgb = within_colours(grey_of(rgb) + factor * (rgb - grey_of(rgb)));
               });
             }},
    Quantity{"path_delay_s", Part::kPath, false,
             [](sim::World&, sim::Uav*, sim::Model* model, sim::Sensor*, double delay_s) {
               model->path->delay += duration_from_seconds(delay_s);
             }},
    Quantity{"path_time_factor", Part::kPath, true,
             [](sim::World&, sim::Uav*, sim::Model* model, sim::Sensor*, double factor) {
               for (uav::Waypoint& point : model->path->waypoints)
                 point.at = duration_from_seconds(factor * to_seconds(point.at));
             }},
    Quantity{"wind_factor", Part::kWind, true,
             [](sim::World& world, sim::Uav*, sim::Model*, sim::Sensor*, double factor) {
               world.wind.v_WA_m_s = factor * world.wind.v_WA_m_s;
             }},
    Quantity{"wind_yaw_deg", Part::kWind, false,
             [](sim::World& world, sim::Uav*, sim::Model*, sim::Sensor*, double yaw_deg) {
               world.wind.v_WA_m_s = rotate(turn(0.0, 0.0, yaw_deg), world.wind.v_WA_m_s);
             }},
    Quantity{"turbulence_factor", Part::kWind, true,
             [](sim::World& world, sim::Uav*, sim::Model*, sim::Sensor*, double factor) {
               world.wind.turbulence *= factor;
             }},
    Quantity{"light_factor", Part::kWorld, true,
             [](sim::World& world, sim::Uav*, sim::Model*, sim::Sensor*, double factor) {
               for_each_light(world, [&](Vec3& rgb) { rgb = factor * rgb; });
             }},
    Quantity{"light_warmth_factor", Part::kWorld, true,
             [](sim::World& world, sim::Uav*, sim::Model*, sim::Sensor*, double factor) {
               const double red = std::sqrt(factor);
               for_each_light(world, [&](Vec3& rgb) { rgb = {red * rgb.x, rgb.y, rgb.z / red}; });
             }},
    Quantity{"friction_factor", Part::kWorld, true,
             [](sim::World& world, sim::Uav*, sim::Model*, sim::Sensor*, double factor) {
               for_each_collision(world, [&](sim::Collision& c) { c.friction *= factor; });
             }},
    Quantity{"sensor_x_m", Part::kSensor, false, kMoveSensor<&Vec3::x>},
    Quantity{"sensor_y_m", Part::kSensor, false, kMoveSensor<&Vec3::y>},
    Quantity{"sensor_z_m", Part::kSensor, false, kMoveSensor<&Vec3::z>},
    Quantity{"sensor_roll_deg", Part::kSensor, false,
             [](sim::World&, sim::Uav*, sim::Model*, sim::Sensor* sensor, double roll_deg) {
               sensor->X_BS.q = sensor->X_BS.q * turn(roll_deg, 0.0, 0.0);
             }},
    Quantity{"sensor_pitch_deg", Part::kSensor, false,
             [](sim::World&, sim::Uav*, sim::Model*, sim::Sensor* sensor, double pitch_deg) {
               sensor->X_BS.q = sensor->X_BS.q * turn(0.0, pitch_deg, 0.0);
             }},
    Quantity{"sensor_yaw_deg", Part::kSensor, false,
             [](sim::World&, sim::Uav*, sim::Model*, sim::Sensor* sensor, double yaw_deg) {
               sensor->X_BS.q = sensor->X_BS.q * turn(0.0, 0.0, yaw_deg);
             }},
};

const Quantity& quantity_of(const Variation& variation) {
  return *std::ranges::find(kQuantities, variation.quantity, &Quantity::name);
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
  if (quantity_of(variation).is_factor && value <= 0.0)
    fail(variation, fmt::format("gives {:.6g}, but a factor is above 0", value));
  return {variation.name, variation.text(), value};
}

/// Of a model and those that are nested in it.
void change_paths(const Variation& variation, double value, sim::World& world) {
  if (!find(world.models, variation.of, variation, "the model").path)
    fail(variation, fmt::format("varies the path of the model '{}', which has none. Give it one "
                                "with [[moving]]",
                                variation.of));
  for (sim::Model& model : world.models)
    if (model.path && (model.name == variation.of || is_nested_in(model, variation.of)))
      quantity_of(variation).change(world, nullptr, &model, nullptr, value);
}

/// With the model or UAV of that name.
void place_anchor(const std::string& name, const uav::Pose& now, const uav::Pose& before,
                  sim::World& world) {
  for (sim::PlacedAnchor& placed : world.anchors)
    if (placed.anchor.name == name) placed.X_WA = now * (uav::inverse(before) * placed.X_WA);
}

void change_uavs(const Variation& variation, double value, sim::World& world) {
  const Quantity& quantity = quantity_of(variation);
  const auto change = [&](sim::Uav& uav) {
    const uav::Pose before = uav.X_WB;
    quantity.change(world, &uav, nullptr, nullptr, value);
    place_anchor(uav.name, uav.X_WB, before, world);
    if (uav.airframe.mass_kg <= 0.0)
      fail(variation,
           fmt::format("gives the UAV '{}' a mass of {:.6g} kg", uav.name, uav.airframe.mass_kg));
  };
  if (!variation.of.empty()) return change(find(world.uavs, variation.of, variation, "the UAV"));
  for (sim::Uav& uav : world.uavs) change(uav);
}

// --- models --------------------------------------------------------------------------------------

/// The names of what touches a model, UAVs included: of each link by itself, as the meter measures
/// distances from UAVs.
std::set<std::string> touching(const sim::World& world, const sim::Model& model) {
  std::set<std::string> names;
  const auto look = [&](const std::string& name, const auto& add_other) {
    for (const sim::Link& link : model.links) {
      sim::World pair;
      sim::Uav as_uav;
      as_uav.body = link;
      as_uav.X_WB = model.X_WM * link.X_ML;
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

/// All that is varied of one model at once: its coordinates are not independent of each other.
void place_model(const std::vector<const Variation*>& variations, std::uint64_t seed,
                 sim::World& world, std::vector<Varied>& values) {
  constexpr std::uint64_t kAttempts = 100;
  const Variation& first = *variations.front();
  sim::Model& model = find(world.models, first.of, first, "the model");
  const sim::Model before = model;
  const std::set<std::string> allowed = touching(world, before);
  for (std::uint64_t attempt = 0; attempt < kAttempts; ++attempt) {
    model = before;
    std::vector<Varied> drawn;
    for (const Variation* variation : variations) {
      drawn.push_back(value_of(*variation, seed, attempt));
      quantity_of(*variation).change(world, nullptr, &model, nullptr, drawn.back().value);
    }
    if (!std::ranges::includes(allowed, touching(world, model))) continue;
    place_anchor(model.name, model.X_WM, before.X_WM, world);
    move_nested(model, before.X_WM, world);
    values.insert(values.end(), drawn.begin(), drawn.end());
    return;
  }
  fail(first, fmt::format("finds no place for the model '{}' with seed {}, in which it touches "
                          "nothing else. Give it more room",
                          model.name, seed));
}

}  // namespace

std::string Variation::text() const {
  return of.empty() ? quantity : fmt::format("{} of {}", quantity, of);
}

std::vector<std::string_view> quantities() {
  std::vector<std::string_view> names;
  for (const Quantity& quantity : kQuantities) names.push_back(quantity.name);
  return names;
}

// Models come last: they make room for the UAVs.
std::vector<Varied> vary(const std::vector<Variation>& variations, std::uint64_t seed,
                         bool is_read_elsewhere, sim::World& world) {
  std::vector<Varied> values;
  std::vector<std::pair<std::string, std::vector<const Variation*>>> of_models;
  for (const Variation& variation : variations) {
    const Part part = quantity_of(variation).part;
    if (is_read_elsewhere && part != Part::kUav && part != Part::kSensor)
      fail(variation,
           fmt::format("varies {}, but this simulator reads the world's file itself. Use "
                       "the embedded simulator, or vary UAVs and sensors only",
                       variation.text()));
    if (part == Part::kWind && world.wind.is_calm())
      fail(variation, "varies the wind, but there is none. Give the scenario a table [wind]");
    if (part == Part::kModel) {
      const auto known =
          std::ranges::find(of_models, variation.of, &decltype(of_models)::value_type::first);
      if (known != of_models.end())
        known->second.push_back(&variation);
      else
        of_models.push_back({variation.of, {&variation}});
      continue;
    }
    values.push_back(value_of(variation, seed, 0));
    if (part == Part::kUav) change_uavs(variation, values.back().value, world);
    if (part == Part::kPath) change_paths(variation, values.back().value, world);
    if (is_of_world(part))
      quantity_of(variation).change(world, nullptr, nullptr, nullptr, values.back().value);
  }
  for (const auto& [model, of_model] : of_models) place_model(of_model, seed, world, values);
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
