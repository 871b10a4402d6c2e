// Assembles a World from the parts that the other files of this library convert: models with their
// links, lights, physics and scene from the world's file, then the UAVs, then the anchors.

#include "checks/sdf_mend.h"
#include "convert/sdf_convert.h"

#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <utility>

#include <tether/sim/bodies.h>
#include <tether/sim/geodesy.h>
#include <tether/sim_sdf/load_world.h>

namespace tether::sim {

using uav::Pose;

namespace {

/// Of a clear day, halfway up.
constexpr uav::Vec3 kSky_rgb{0.55, 0.71, 0.89};

/// Whether the model may move, by the number of links that do. Without --strict, it stays.
/// @param before the world's moving links so far
bool may_move(const SdfSource& source, const sdf::Model& model, std::size_t before,
              const WarningSink& warn) {
  if (before + model.LinkCount() <= kMaxMovingLinks) return true;
  if (source.options().is_tolerant) {
    warn_at(
        source, model.Element(), Consequence::kBehavesDifferent,
        "does not move: more than " + std::to_string(kMaxMovingLinks) + " links of the world would",
        warn);
    return false;
  }
  refuse(source, model.LinkByIndex(kMaxMovingLinks - before)->Element(),
         "exceeds the limit of " + std::to_string(kMaxMovingLinks) +
             " moving links of a world; make models that need not move <static>");
}

/// Adds a model and, behind it, the models nested in it, each as a separate model.
void add_model(const SdfSource& source, const sdf::Model& model, const Pose& X_WP,
               const std::string& prefix, bool parent_is_static, const WarningSink& warn,
               World& world) {
  Model result;
  result.name = prefix + model.Name();
  result.X_WM = X_WP * resolved_pose(source, model);
  result.is_static = parent_is_static || model.Static();
  if (!result.is_static) {
    result.is_static = !may_move(source, model, moving_bodies(world).size(), warn);
  }
  for (std::uint64_t i = 0; i < model.LinkCount(); ++i) {
    const sdf::Link& link = *model.LinkByIndex(i);
    result.links.push_back(read_link(source, link, warn));
    for (std::uint64_t k = 0; k < link.LightCount(); ++k) {
      world.lights.push_back(
          read_light(source, *link.LightByIndex(k), result.X_WM * result.links.back().X_ML));
    }
  }
  const Pose X_WM = result.X_WM;
  const bool is_static = result.is_static;
  const std::string name = result.name;
  world.models.push_back(std::move(result));
  for (std::uint64_t i = 0; i < model.ModelCount(); ++i) {
    add_model(source, *model.ModelByIndex(i), X_WM, name + "::", is_static, warn, world);
  }
}

/// Warns of lights and nested models that would move with their parents.
void warn_of_lost_motion(const SdfSource& source, const sdf::Model& model, bool parent_is_static,
                         const WarningSink& warn) {
  const bool is_static = parent_is_static || model.Static();
  for (std::uint64_t i = 0; i < model.ModelCount(); ++i) {
    const sdf::Model& nested = *model.ModelByIndex(i);
    if (!is_static) {
      warn_at(source, nested.Element(), Consequence::kBehavesDifferent,
              "is nested in a dynamic model; it moves independently of that model", warn);
    }
    warn_of_lost_motion(source, nested, is_static, warn);
  }
  for (std::uint64_t i = 0; !is_static && i < model.LinkCount(); ++i) {
    const sdf::Link& link = *model.LinkByIndex(i);
    for (std::uint64_t k = 0; k < link.LightCount(); ++k) {
      warn_at(source, link.LightByIndex(k)->Element(), Consequence::kLooksDifferent,
              "is on a dynamic model; it stays at its start pose", warn);
    }
  }
}

void read_gravity(const SdfSource& source, const sdf::World& sdf_world, World& world) {
  const auto gravity = sdf_world.Gravity();
  if (gravity.Z() > 0.0)
    refuse(source, sdf_world.Element()->FindElement("gravity"), "points up; it must point down");
  world.gravity_m_s2 = std::abs(gravity.Z());
  world.gravity_x_m_s2 = gravity.X();
  world.gravity_y_m_s2 = gravity.Y();
}

/// Of several <physics>, the one that SDF takes: the default one, else the first.
void read_step(const SdfSource& source, const sdf::World& sdf_world, World& world) {
  const sdf::Physics* physics = sdf_world.PhysicsDefault();
  if (physics == nullptr || !physics->Element()) return;
  const sdf::ElementPtr element = physics->Element()->FindElement("max_step_size");
  if (!element || !element->GetExplicitlySetInFile()) return;
  world.step = duration_from_seconds(physics->MaxStepSize());
  world.step_from = "world";
  world.step_at = source.where(element);
  if (world.step < kLeastStep || world.step > kMostStep) {
    refuse(source, element,
           "is " + element->GetValue()->GetAsString() +
               "; it must be between 0.00001 and 0.1 seconds");
  }
}

void read_earth_and_air(const SdfSource& source, const sdf::World& sdf_world, World& world) {
  if (const auto* place = sdf_world.SphericalCoordinates()) {
    world.place = Place{place->LatitudeReference().Degree(), place->LongitudeReference().Degree(),
                        place->ElevationReference(), place->HeadingOffset().Radian()};
    const sdf::ElementPtr frame = sdf_world.Element()
                                      ->GetElement("spherical_coordinates")
                                      ->FindElement("world_frame_orientation");
    if (frame && frame->Get<std::string>() != "ENU")
      refuse(source, frame, "is not ENU, the only orientation that Tether knows");
  }
  const sdf::ElementPtr field = sdf_world.Element()->FindElement("magnetic_field");
  const bool is_given = field && field->GetExplicitlySetInFile();
  world.magnetic_field_T = world.place && !is_given
                               ? from_enu(*world.place, earth_field_T(*world.place))
                               : to_vec3(sdf_world.MagneticField());
  world.wind.v_WA_m_s = to_vec3(sdf_world.WindLinearVelocity());
}

void read_scene(const sdf::Scene* scene, World& world) {
  if (scene == nullptr) return;
  world.ambient_rgb = to_vec3(scene->Ambient());
  world.background_rgb = scene->Sky() != nullptr ? kSky_rgb : to_vec3(scene->Background());
  if (scene->Shadows()) return;
  for (Light& light : world.lights) light.cast_shadows = false;
}

/// Where the models were when the world was saved: Gazebo 11 puts them there.
void apply_state(const SdfSource& source, World& world) {
  const sdf::ElementPtr state = source.element()->GetElement("world")->FindElement("state");
  if (!state) return;
  for (sdf::ElementPtr saved = state->FindElement("model"); saved;
       saved = saved->GetNextElement("model")) {
    const std::string name = name_attribute(saved);
    const sdf::ElementPtr pose = saved->FindElement("pose");
    const auto model = std::ranges::find(world.models, name, &Model::name);
    if (!pose || model == world.models.end()) continue;
    const Pose X_WM = to_pose(pose->Get<ignition::math::Pose3d>());
    if (!(uav::norm(X_WM.p) <= kMaxLength_m)) continue;  // it fell for ever
    const Pose X_new_old = X_WM * uav::inverse(model->X_WM);
    for (Model& part : world.models)
      if (part.name == name || part.name.starts_with(name + "::"))
        part.X_WM = X_new_old * part.X_WM;
  }
}

World read_world(const SdfSource& source, const WarningSink& warn) {
  if (source.root().WorldCount() == 0 && source.root().Model() != nullptr)
    throw Error(ErrorCode::kBadFile, {source.file().string(), 0},
                "is a model, not a world. Give a file with a <world>; it can <include> this model, "
                "and a scenario names it with 'model' if it is a UAV")
        .about("<world>");
  if (source.root().WorldCount() != 1) {
    throw Error(ErrorCode::kBadFile, {source.file().string(), 0},
                "has " + std::to_string(source.root().WorldCount()) +
                    " <world> elements; a world file must have exactly one")
        .about("<world>");
  }
  const sdf::World& sdf_world = *source.root().WorldByIndex(0);

  World world;
  world.name = sdf_world.Name();
  read_gravity(source, sdf_world, world);
  read_step(source, sdf_world, world);
  read_earth_and_air(source, sdf_world, world);
  for (std::uint64_t i = 0; i < sdf_world.ModelCount(); ++i) {
    add_model(source, *sdf_world.ModelByIndex(i), {}, "", false, warn, world);
    warn_of_lost_motion(source, *sdf_world.ModelByIndex(i), false, warn);
  }
  for (std::uint64_t i = 0; i < sdf_world.LightCount(); ++i) {
    world.lights.push_back(read_light(source, *sdf_world.LightByIndex(i), {}));
  }
  for (auto road = sdf_world.Element()->FindElement("road"); road;
       road = road->GetNextElement("road"))
    if (auto model = read_road(source, road, warn)) world.models.push_back(std::move(*model));
  read_scene(sdf_world.Scene(), world);
  apply_state(source, world);
  return world;
}

LightKind to_light_kind(sdf::LightType type) {
  if (type == sdf::LightType::DIRECTIONAL) return LightKind::kDirectional;
  return type == sdf::LightType::SPOT ? LightKind::kSpot : LightKind::kPoint;
}

/// Reads a file and makes something of it. `read` gets the source.
template <class Read>
auto read_file(const std::filesystem::path& file, const WorldOptions& options, SdfPurpose purpose,
               const WarningSink& warn, Read read) {
  WorldOptions own = options;
  if (purpose == SdfPurpose::kWorld) own.is_tolerant = !options.is_strict;
  return ask_library({file.string()}, [&] {
    SdfSource source(file, own, warn);
    check_elements(source, purpose, warn);
    mend(source, warn);
    source.load();
    return read(source);
  });
}

/// Rotors only push up: without a weight to carry, they cannot turn the UAV either.
constexpr double kLeastGravity_m_s2 = 0.1;

void add_uavs(const WorldRequest& request, const WarningSink& warn, World& world) {
  if (!request.uavs.empty() && world.gravity_m_s2 < kLeastGravity_m_s2)
    throw Error(ErrorCode::kBadFile, {request.world.string(), 0},
                "has no gravity, without which a multirotor cannot be controlled; give it a "
                "<gravity> of at least 0 0 -0.1")
        .about("<gravity>");
  std::set<std::string> names;
  std::map<std::filesystem::path, Uav> read;  // each file is read once
  for (const UavPlacement& placement : request.uavs) {
    if (!names.insert(placement.name).second) {
      throw Error(ErrorCode::kBadFile,
                  "two UAVs have the name '" + placement.name + "'; give each a unique name")
          .about(placement.name);
    }
    const auto [known, is_new] = read.try_emplace(placement.model);
    if (is_new)
      known->second = read_file(placement.model, request.options, SdfPurpose::kUav, warn,
                                [&](const SdfSource& source) {
                                  Uav uav = read_uav(source, world.gravity_m_s2, warn);
                                  world.files.merge(source.files());
                                  return uav;
                                });
    Uav& uav = world.uavs.emplace_back(known->second);
    uav.name = placement.name;
    uav.X_WB = start_pose(placement);
  }
}

/// What sensors of the Earth measure although the world does not say it. None of it changes a
/// flight by itself.
void warn_of_earth(const World& world, const WarningSink& warn) {
  if (!warn) return;
  const auto warn_first = [&](uav::SensorKind kind, const std::string& what) {
    for (const Uav& uav : world.uavs)
      for (const Sensor& sensor : uav.sensors)
        if (sensor.kind() == kind)
          return warn(
              {Consequence::kNoEffect, sensor.declared_at, "sensor '" + sensor.name + "'", what});
  };
  if (!world.place)
    warn_first(uav::SensorKind::kNavSat,
               "measures latitude and longitude, but the world has no <spherical_coordinates>: it "
               "is put near Zurich, as PX4's worlds are");
}

}  // namespace

Light read_light(const SdfSource& source, const sdf::Light& light, const Pose& X_WP) {
  Light result;
  result.name = light.Name();
  result.kind = to_light_kind(light.Type());
  result.X_WL = X_WP * resolved_pose(source, light);
  result.direction = to_vec3(light.Direction());
  if (result.kind != LightKind::kPoint && uav::norm(result.direction) == 0.0) {
    refuse(source, light.Element(), "has a <direction> of length 0");
  }
  result.diffuse_rgb = light.Intensity() * to_vec3(light.Diffuse());
  result.specular_rgb = light.Intensity() * to_vec3(light.Specular());
  result.attenuation_constant = light.ConstantAttenuationFactor();
  result.attenuation_linear = light.LinearAttenuationFactor();
  result.attenuation_quadratic = light.QuadraticAttenuationFactor();
  result.spot_outer_angle_rad = light.SpotOuterAngle().Radian();
  result.spot_falloff = light.SpotFalloff();
  result.cast_shadows = light.CastShadows();
  return result;
}

World load_world(const WorldRequest& request, const WarningSink& any_warn) {
  const WarningSink warn = printable_warnings(any_warn);
  return read_file(
      request.world, request.options, SdfPurpose::kWorld, warn, [&](const SdfSource& source) {
        World world = read_world(source, warn);
        world.file = source.file();
        world.sdf_files = source.sdf_files();
        world.is_strict = request.options.is_strict;
        add_uavs(request, warn, world);
        warn_of_earth(world, warn);
        for (const std::string& name : request.anchors)
          world.anchors.push_back(find_anchor(source, world, name, request.anchors_at));
        world.files.merge(source.files());
        return world;
      });
}

Uav load_uav(const std::filesystem::path& model, const WorldOptions& options, double gravity_m_s2,
             const WarningSink& warn) {
  const WarningSink printable = printable_warnings(warn);
  return read_file(model, options, SdfPurpose::kUav, printable, [&](const SdfSource& source) {
    return read_uav(source, gravity_m_s2, printable);
  });
}

}  // namespace tether::sim
