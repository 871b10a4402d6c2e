// How a value changes the world: positions and angles are added to those of the files; factors
// multiply. A UAV's controller knows its mass and its rotors, as that of a real one is tuned to
// them.

#include "quantity.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include <tether/base/units.h>
#include <tether/scenario/scenario.h>

namespace tether::scenario {
namespace {

using Change = decltype(Quantity::change);

constexpr toml::Range kAnyNumber{.min = -1e6, .max = 1e6};
constexpr toml::Range kAnyFactor{.min = 0.0, .max = 1e6, .above_min = true};
constexpr toml::Range kFactorOrNone{.min = 0.0, .max = 1e6};  // of what can be absent
constexpr toml::Range kTurn_deg{.min = -360.0, .max = 360.0};
constexpr toml::Range kPathDelay_s{.min = 0.0, .max = kLongestRun_s};
constexpr toml::Range kSensorShift_m{.min = -100.0, .max = 100.0};

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
    Quantity{"start_x_m", Part::kStart, kAnyNumber, kMoveUav<&Vec3::x>},
    Quantity{"start_y_m", Part::kStart, kAnyNumber, kMoveUav<&Vec3::y>},
    Quantity{"start_z_m", Part::kStart, kAnyNumber, kMoveUav<&Vec3::z>},
    Quantity{"start_yaw_deg", Part::kStart, kTurn_deg,
             [](sim::World&, sim::Uav* uav, sim::Model*, sim::Sensor*, double yaw_deg) {
               uav->X_WB.q = turn(0.0, 0.0, yaw_deg) * uav->X_WB.q;
             }},
    Quantity{"mass_factor", Part::kUav, kAnyFactor,
             [](sim::World&, sim::Uav* uav, sim::Model*, sim::Sensor*, double factor) {
               scale_mass(*uav, factor * uav->airframe.mass_kg);
             }},
    Quantity{"payload_kg", Part::kUav, kAnyNumber,
             [](sim::World&, sim::Uav* uav, sim::Model*, sim::Sensor*, double payload_kg) {
               scale_mass(*uav, uav->airframe.mass_kg + payload_kg);
             }},
    Quantity{"thrust_factor", Part::kUav, kAnyFactor,
             [](sim::World&, sim::Uav* uav, sim::Model*, sim::Sensor*, double factor) {
               uav->airframe.thrust_coefficient *= factor;
             }},
    Quantity{"drag_factor", Part::kUav, kAnyFactor,
             [](sim::World&, sim::Uav* uav, sim::Model*, sim::Sensor*, double factor) {
               uav->airframe.drag_coefficient *= factor;
               uav->airframe.linear_drag_N_s_m *= factor;
             }},
    Quantity{"motor_lag_factor", Part::kUav, kAnyFactor,
             [](sim::World&, sim::Uav* uav, sim::Model*, sim::Sensor*, double factor) {
               uav->airframe.time_constant_up_s *= factor;
               uav->airframe.time_constant_down_s *= factor;
             }},
    Quantity{"model_x_m", Part::kModel, kAnyNumber, kMoveModel<&Vec3::x>},
    Quantity{"model_y_m", Part::kModel, kAnyNumber, kMoveModel<&Vec3::y>},
    Quantity{"model_z_m", Part::kModel, kAnyNumber, kMoveModel<&Vec3::z>},
    Quantity{"model_yaw_deg", Part::kModel, kTurn_deg,
             [](sim::World&, sim::Uav*, sim::Model* model, sim::Sensor*, double yaw_deg) {
               model->X_WM.q = turn(0.0, 0.0, yaw_deg) * model->X_WM.q;
             }},
    Quantity{"model_brightness_factor", Part::kModel, kAnyFactor,
             [](sim::World&, sim::Uav*, sim::Model* model, sim::Sensor*, double factor) {
               for_each_colour(*model, [&](Vec3& rgb) { rgb = factor * rgb; });
             }},
    Quantity{"model_hue_deg", Part::kModel, kTurn_deg,
             [](sim::World&, sim::Uav*, sim::Model* model, sim::Sensor*, double hue_deg) {
               for_each_colour(*model, [&](Vec3& rgb) { rgb = turned_hue(rgb, hue_deg); });
             }},
    Quantity{"model_saturation_factor", Part::kModel, kFactorOrNone,
             [](sim::World&, sim::Uav*, sim::Model* model, sim::Sensor*, double factor) {
               for_each_colour(*model, [&](Vec3& rgb) {
                 rgb = within_colours(grey_of(rgb) + factor * (rgb - grey_of(rgb)));
               });
             }},
    Quantity{"path_delay_s", Part::kPath, kPathDelay_s,
             [](sim::World&, sim::Uav*, sim::Model* model, sim::Sensor*, double delay_s) {
               model->path->delay += duration_from_seconds(delay_s);
             }},
    Quantity{"path_time_factor", Part::kPath, kAnyFactor,
             [](sim::World&, sim::Uav*, sim::Model* model, sim::Sensor*, double factor) {
               for (uav::Waypoint& point : model->path->waypoints)
                 point.at = duration_from_seconds(factor * to_seconds(point.at));
             }},
    Quantity{"wind_factor", Part::kWind, kFactorOrNone,
             [](sim::World& world, sim::Uav*, sim::Model*, sim::Sensor*, double factor) {
               world.wind.v_WA_m_s = factor * world.wind.v_WA_m_s;
             }},
    Quantity{"wind_yaw_deg", Part::kWind, kTurn_deg,
             [](sim::World& world, sim::Uav*, sim::Model*, sim::Sensor*, double yaw_deg) {
               world.wind.v_WA_m_s = rotate(turn(0.0, 0.0, yaw_deg), world.wind.v_WA_m_s);
             }},
    Quantity{"turbulence_factor", Part::kWind, kFactorOrNone,
             [](sim::World& world, sim::Uav*, sim::Model*, sim::Sensor*, double factor) {
               world.wind.turbulence *= factor;
             }},
    Quantity{"light_factor", Part::kWorld, kAnyFactor,
             [](sim::World& world, sim::Uav*, sim::Model*, sim::Sensor*, double factor) {
               for_each_light(world, [&](Vec3& rgb) { rgb = factor * rgb; });
             }},
    Quantity{"light_warmth_factor", Part::kWorld, kAnyFactor,
             [](sim::World& world, sim::Uav*, sim::Model*, sim::Sensor*, double factor) {
               const double red = std::sqrt(factor);
               for_each_light(world, [&](Vec3& rgb) { rgb = {red * rgb.x, rgb.y, rgb.z / red}; });
             }},
    Quantity{"friction_factor", Part::kWorld, kAnyFactor,
             [](sim::World& world, sim::Uav*, sim::Model*, sim::Sensor*, double factor) {
               for_each_collision(world, [&](sim::Collision& c) { c.friction *= factor; });
             }},
    Quantity{"sensor_x_m", Part::kSensor, kSensorShift_m, kMoveSensor<&Vec3::x>},
    Quantity{"sensor_y_m", Part::kSensor, kSensorShift_m, kMoveSensor<&Vec3::y>},
    Quantity{"sensor_z_m", Part::kSensor, kSensorShift_m, kMoveSensor<&Vec3::z>},
    Quantity{"sensor_roll_deg", Part::kSensor, kTurn_deg,
             [](sim::World&, sim::Uav*, sim::Model*, sim::Sensor* sensor, double roll_deg) {
               sensor->X_BS.q = sensor->X_BS.q * turn(roll_deg, 0.0, 0.0);
             }},
    Quantity{"sensor_pitch_deg", Part::kSensor, kTurn_deg,
             [](sim::World&, sim::Uav*, sim::Model*, sim::Sensor* sensor, double pitch_deg) {
               sensor->X_BS.q = sensor->X_BS.q * turn(0.0, pitch_deg, 0.0);
             }},
    Quantity{"sensor_yaw_deg", Part::kSensor, kTurn_deg,
             [](sim::World&, sim::Uav*, sim::Model*, sim::Sensor* sensor, double yaw_deg) {
               sensor->X_BS.q = sensor->X_BS.q * turn(0.0, 0.0, yaw_deg);
             }},
};

}  // namespace

std::span<const Quantity> quantities() {
  return kQuantities;
}

}  // namespace tether::scenario
