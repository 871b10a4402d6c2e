#include "coordinator_impl.h"
#include "header_facts.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <utility>

#include <tether/base/text.h>

/// The header of a run's record: everything that its numbers depend on.
namespace tether::coordinator {

namespace {

record::CameraInfo describe(const uav::SensorDescription& sensor,
                            const uav::CameraProperties& camera) {
  const uav::Pose& X_BS = sensor.X_BS;
  const uav::CameraModel& model = camera.model;
  return {.p_BS_m = {X_BS.p.x, X_BS.p.y, X_BS.p.z},
          .q_BS = {X_BS.q.w, X_BS.q.x, X_BS.q.y, X_BS.q.z},
          .width_px = model.width_px,
          .height_px = model.height_px,
          .fx_px = model.fx_px,
          .fy_px = model.fy_px,
          .cx_px = model.cx_px,
          .cy_px = model.cy_px,
          .k1 = model.k1,
          .k2 = model.k2,
          .k3 = model.k3,
          .p1 = model.p1,
          .p2 = model.p2,
          .depth_min_m = camera.min_m,
          .depth_max_m = camera.max_m,
          .models = camera.models,
          .joints = sensor.joints};
}

std::string text_of(const ControllerOptions& controller, const std::string& version) {
  return version.empty() ? controller.name : controller.name + " " + version;
}

std::vector<record::BuildPart> parts_of(const link::Hello& hello) {
  std::vector<record::BuildPart> parts;
  for (const link::BuildPart& part : hello.build)
    parts.push_back({printable(part.name), printable(part.value)});
  return parts;
}

record::SensorInfo describe(const std::string& uav, const uav::SensorDescription& sensor,
                            const uav::SensorTiming& timing, const uav::DriverModel& driver) {
  record::SensorInfo info{.uav = uav, .name = sensor.name, .kind = std::string(sensor.kind_name())};
  std::tie(info.delay_min, info.delay_max) =
      uav::bounds(std::visit([](const auto& t) { return t.delay; }, timing));
  if (const auto* periodic = std::get_if<uav::PeriodicTiming>(&timing)) {
    info.periodic = true;
    info.period = periodic->period;
    info.phase = periodic->phase;
  }
  if (driver != uav::DriverModel{})
    info.driver = {.stamp_offset = driver.stamp_offset,
                   .stamp_jitter = driver.stamp_jitter,
                   .stamp_drift_ppb = driver.stamp_drift_ppb,
                   .lost_probability = driver.lost_probability,
                   .repeated_probability = driver.repeated_probability};
  if (const auto* camera = std::get_if<uav::CameraProperties>(&sensor.properties))
    info.camera = describe(sensor, *camera);
  return info;
}

std::vector<record::JointInfo> describe(const std::vector<uav::Joint>& joints) {
  std::vector<record::JointInfo> infos;
  for (const auto& [name, p, axis, min_rad, max_rad, rate_rad_s] : joints)
    infos.push_back(
        {name, {p.x, p.y, p.z}, {axis.x, axis.y, axis.z}, min_rad, max_rad, rate_rad_s});
  return infos;
}

record::Anchor describe(const sim::World& world, const sim::PlacedAnchor& placed) {
  const auto& [anchor, X_WA] = placed;
  record::Anchor info{.name = anchor.name,
                      .shape = std::string(uav::name(anchor.shape)),
                      .size_m = {anchor.size_m.x, anchor.size_m.y, anchor.size_m.z},
                      .p_WA_m = {X_WA.p.x, X_WA.p.y, X_WA.p.z},
                      .q_WA = {X_WA.q.w, X_WA.q.x, X_WA.q.y, X_WA.q.z}};
  const auto model = std::ranges::find(world.models, anchor.name, &sim::Model::name);
  if (model == world.models.end()) {
    const auto uav = std::ranges::find(world.uavs, anchor.name, &sim::Uav::name);
    if (uav == world.uavs.end()) return info;  // of a world that was not read from a file
    const uav::Vec3 p_BA = (inverse(uav->X_WB) * X_WA).p;
    info.uav = uav->name;
    std::tie(info.p_BA_m[0], info.p_BA_m[1], info.p_BA_m[2]) = std::tie(p_BA.x, p_BA.y, p_BA.z);
    return info;
  }
  if (!model->path) return info;
  for (const uav::Waypoint& point : model->path->waypoints)
    info.path.push_back({point.at, {point.p_m.x, point.p_m.y, point.p_m.z}, point.yaw_rad});
  info.path_repeats = model->path->repeats;
  info.path_delay = model->path->delay;
  std::tie(info.p_WO_m[0], info.p_WO_m[1], info.p_WO_m[2]) =
      std::tie(model->path->p_WO.x, model->path->p_WO.y, model->path->p_WO.z);
  return info;
}

/// Of all rotors at full speed together with gravity, and the drag of the wind.
double max_acceleration_m_s2(const uav::MultirotorParameters& airframe, const sim::World& world) {
  const double speed = airframe.max_rotor_speed_rad_s;
  const auto rotors = static_cast<double>(airframe.rotors.size());
  const double thrust_N = rotors * airframe.thrust_coefficient * speed * speed;
  const double drag_N = (airframe.linear_drag_N_s_m + rotors * airframe.drag_coefficient * speed) *
                        most_wind_m_s(world.wind);
  return (thrust_N + drag_N) / airframe.mass_kg + norm(felt_at_rest(world));
}

record::LoadInfo describe(const sim::Uav& uav, const sim::World& world) {
  record::LoadInfo info{uav.airframe.mass_kg, norm(felt_at_rest(world)), {}};
  for (const sim::Payload& payload : uav.payloads)
    info.payloads.push_back({payload.mass_kg, payload.from, payload.until});
  return info;
}

/// Of all rotors at full speed, as if each one turned the UAV the same way.
double max_angular_acceleration_rad_s2(const uav::MultirotorParameters& airframe) {
  const uav::Vec3& inertia = airframe.inertia_kg_m2;
  const double least_kg_m2 = std::min({inertia.x, inertia.y, inertia.z});
  if (!(least_kg_m2 > 0.0)) return 0.0;
  double arms_m = 0.0;
  for (const uav::Rotor& rotor : airframe.rotors)
    arms_m += norm(rotor.p_BR) + airframe.moment_coefficient_m;
  return arms_m * max_rotor_thrust_N(airframe) / least_kg_m2;
}

}  // namespace

record::Header Coordinator::Impl::make_header() const {
  record::Header header = options_.header;
  header.seed = options_.seed;
  header.policy = std::string(sync::name(options_.policy));
  header.simulator = stepper_.simulator().description();
  header.step = grid().dt();
  header.ground_truth_period = options_.ground_truth_period;
  header.real_time_factor = options_.real_time_factor;
  header.wall_at_start = *began_;
  header.reports_contacts = stepper_.simulator().reports_contacts();
  header.only_uavs_move = only_uavs_move(world());
  header.moves_by_forces = stepper_.simulator().moves_by_forces();
  header.time_limit = watchdog_.st_limit().time_since_epoch();
  if (sessions_.size() > 1) header.radio = describe(options_.radio);
  for (const Session& session : sessions_) {
    const sim::Uav& uav = world().uavs[session.uav];
    header.suts.push_back(
        {.uav = session.uav_name,
         .sut = session.hello.sut,
         .clock = session.hello.clock,
         .command_latency = uav::bounds(session.command_latency).first,
         .concurrent = session.hello.concurrent,
         .cores = session.hello.clock.adds_up_cores() ? session.cores : 0,
         .max_acceleration_m_s2 = max_acceleration_m_s2(uav.airframe, world()),
         .required_clock = options_.uavs[session.uav].clock,
         .build_id = session.hello.build_id,
         .build = parts_of(session.hello),
         .replay = options_.uavs[session.uav].replayed_from,
         .computer = options_.uavs[session.uav].computer,
         .launcher = options_.uavs[session.uav].launcher,
         .extent_m = extent_m(uav.body),
         .max_angular_acceleration_rad_s2 = max_angular_acceleration_rad_s2(uav.airframe),
         .energy = describe_energy(uav, world().gravity_m_s2)});
    record::SutInfo& sut = header.suts.back();
    sut.joints = describe(uav.joints);
    if (!uav.payloads.empty()) sut.load = describe(uav, world());
    sut.as_is = options_.uavs[session.uav].as_is;
    if (!std::holds_alternative<uav::ConstantDelay>(session.command_latency))
      sut.max_command_latency = uav::bounds(session.command_latency).second;
    if (const auto& loss = options_.uavs[session.uav].setpoint_loss) {
      sut.setpoint_timeout = loss->timeout;
      sut.on_setpoint_loss = name(loss->action);
    }
    if (const auto& controller = options_.uavs[session.uav].controller)
      sut.controller = {.name = text_of(*controller, controllers_.version(session.uav)),
                        .estimate = controller->estimate,
                        .period = controller->period,
                        .link_baud = controller->link_baud,
                        .link_latency = controller->link_latency};
    if (time_of(session).facts().shares_board) {
      header.suts.back().board = options_.boards[*options_.uavs[session.uav].board].name;
      header.suts.back().pinned_core = options_.uavs[session.uav].pinned_core;
    }
    const uav::Catalogue catalogue = sim::make_catalogue(world(), uav);
    for (std::size_t i = 0; i < catalogue.sensors.size(); ++i)
      header.sensors.push_back(describe(uav.name, catalogue.sensors[i],
                                        options_.uavs[session.uav].timings[i],
                                        uav.sensors[i].driver));
  }
  for (const Board& board : options_.boards) {
    const bool is_shared =
        std::ranges::any_of(header.suts, [&](const auto& sut) { return sut.board == board.name; });
    if (is_shared)
      header.boards.push_back({.name = board.name, .cores = board.cores, .is_real = board.is_real});
  }
  for (const sim::PlacedAnchor& anchor : world().anchors)
    header.anchors.push_back(describe(world(), anchor));
  return header;
}

}  // namespace tether::coordinator
