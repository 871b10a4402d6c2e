#include <cmath>
#include <limits>
#include <utility>

#include <tether/base/error.h>
#include <tether/base/random.h>
#include <tether/base/units.h>
#include <tether/sim_testing/fake_simulator.h>

namespace tether::sim {

using uav::Vec3;

namespace {

constexpr std::size_t kNumbersPerBody = 8;
constexpr double kWallX_m = 10.0;
const Vec3 kUp{0.0, 0.0, 1.0};

[[noreturn]] void broken_call(const std::string& what) {
  throw Error(ErrorCode::kInternal, "FakeSimulator: " + what);
}

std::vector<Sensor> make_sensors() {
  Sensor camera{"camera", {}, 30.0, CameraModel{}};
  std::get<CameraModel>(camera.model).intrinsics =
      uav::CameraModel::from_horizontal_fov(8, 6, rad_from_deg(80.0));
  Sensor imu{"imu", {}, 20.0, ImuModel{}};
  Sensor range{"range", {}, 0.0, RangeModel{0.1, 20.0, 0.0, {}}};
  return {camera, imu, range};
}

uav::Quat q_from_yaw(double yaw_rad) {
  return uav::from_axis_angle(kUp, yaw_rad);
}

/// Velocity of a body in W: the commanded one, turned by its heading.
Vec3 velocity_W(double yaw_rad, const uav::VelocityCommand& command) {
  return uav::rotate(q_from_yaw(yaw_rad), command.velocity_H_m_s);
}

void put_instant(SimTime at, std::vector<std::uint8_t>& bytes) {
  const auto ns = static_cast<std::uint64_t>(to_ns(at));
  for (std::size_t i = 0; i < 8 && i < bytes.size(); ++i) {
    bytes[i] = static_cast<std::uint8_t>(ns >> (8 * i));
  }
}

uav::CameraSample make_image(const CameraModel& camera, SimTime at, std::uint64_t index,
                             const RandomKey& key) {
  uav::CameraSample image{at, index, camera.intrinsics.width_px, camera.intrinsics.height_px, {}};
  image.rgb.resize(static_cast<std::size_t>(image.width_px * image.height_px * 3));
  KeyedRandom random(key);
  for (std::uint8_t& byte : image.rgb) byte = static_cast<std::uint8_t>(random.bits());
  put_instant(at, image.rgb);
  const std::size_t pixels = image.rgb.size() / 3;
  if (uav::has_depth(camera.kind)) image.depth_m.assign(pixels, 2.5F);
  if (camera.kind == uav::CameraKind::kSegmentation) image.labels.assign(pixels, 1);
  if (!uav::has_color(camera.kind)) image.rgb.clear();
  return image;
}

double range_ahead_m(const RangeModel& range, const Vec3& p_WB, double yaw_rad) {
  const double ahead = std::cos(yaw_rad);
  const double distance_m = ahead > 1e-9 ? (kWallX_m - p_WB.x) / ahead : range.max_m + 1.0;
  if (distance_m < range.min_m) return -std::numeric_limits<double>::infinity();
  return distance_m > range.max_m ? std::numeric_limits<double>::infinity() : distance_m;
}

}  // namespace

World make_fake_world(std::size_t count, Duration step) {
  World world;
  world.name = "fake";
  world.step = step;
  for (std::size_t i = 0; i < count; ++i) {
    Uav uav;
    uav.name = "uav" + std::to_string(i);
    uav.X_WB.p = {0.0, static_cast<double>(i), 1.0};
    uav.body.name = "body";
    uav.airframe = uav::hummingbird();
    uav.sensors = make_sensors();
    world.uavs.push_back(std::move(uav));
  }
  world.anchors.push_back(
      {{"blue_box", uav::AnchorShape::kBox, {0.4, 0.4, 0.4}, {0.05, 0.15, 0.85}},
       {{8.0, 0.0, 1.0}, {}}});
  return world;
}

FakeSimulator::FakeSimulator(World world)
    : world_(std::move(world)), grid_(world_.step), joints_(world_) {
  reset(0);
  calls_ = {};
}

void FakeSimulator::on_advance(std::function<void(SimTime, SimTime)> callback) {
  on_advance_ = std::move(callback);
}

void FakeSimulator::on_measure(std::function<void(std::size_t, std::size_t)> callback) {
  on_measure_ = std::move(callback);
}

void FakeSimulator::reset(std::uint64_t seed) {
  ++calls_.reset;
  seed_ = seed;
  now_ = SimTime{};
  applied_.clear();
  expected_.clear();
  bodies_.clear();
  joints_.reset();
  for (const Uav& uav : world_.uavs) {
    bodies_.push_back({uav.X_WB.p, uav::yaw_rad(uav.X_WB.q), {}});
    if (uav.energy) bodies_.back().meter.emplace(*uav.energy, uav.airframe, world_.gravity_m_s2);
  }
}

void FakeSimulator::advance_to(SimTime t) {
  if (t < now_) broken_call("asked to go back in time");
  if (!grid_.contains(t)) broken_call("asked to stop between two step boundaries");
  ++calls_.advance_to;
  if (on_advance_) on_advance_(now_, t);
  while (now_ < t) step();
}

void FakeSimulator::step() {
  const double dt_s = to_seconds(grid_.dt());
  for (Body& body : bodies_) {
    body.p_WB = body.p_WB + dt_s * velocity_W(body.yaw_rad, body.command);
    body.yaw_rad += dt_s * body.command.yaw_rate_rad_s;
    const uav::MultirotorParameters& airframe =
        world_.uavs[static_cast<std::size_t>(&body - bodies_.data())].airframe;
    if (body.meter)
      body.meter->step(now_, grid_.dt(), {}, uav::hover_state(airframe, world_.gravity_m_s2, 0.0));
  }
  joints_.step();
  now_ += grid_.dt();
  ++calls_.steps;
}

void FakeSimulator::check_uav(std::size_t uav) const {
  if (uav >= bodies_.size()) broken_call("no UAV of index " + std::to_string(uav));
}

std::optional<energy::Status> FakeSimulator::battery(std::size_t uav) const {
  check_uav(uav);
  if (!bodies_[uav].meter) return std::nullopt;
  return bodies_[uav].meter->status();
}

void FakeSimulator::computing(std::size_t uav, double cores) {
  check_uav(uav);
  bodies_[uav].meter->computing(cores);
}

void FakeSimulator::apply(std::size_t uav, const uav::Setpoint& setpoint) {
  check_uav(uav);
  if (setpoint.flies())
    bodies_[uav].command = heading_velocity(setpoint).value_or(uav::VelocityCommand{});
  if (setpoint.has(uav::kJoints)) joints_.command(uav, setpoint.joints_rad);
  applied_.push_back({now_, uav, setpoint});
}

void FakeSimulator::capture(Snapshot& snapshot) const {
  ++calls_.capture;
  snapshot.at = now_;
  snapshot.state.clear();
  for (const Body& body : bodies_) {
    const Vec3 v_WB = velocity_W(body.yaw_rad, body.command);
    snapshot.state.insert(snapshot.state.end(),
                          {body.p_WB.x, body.p_WB.y, body.p_WB.z, body.yaw_rad, v_WB.x, v_WB.y,
                           v_WB.z, body.command.yaw_rate_rad_s});
  }
}

uav::Sample FakeSimulator::measure(const Snapshot& snapshot, std::size_t uav, std::size_t sensor,
                                   std::uint64_t index) {
  check_uav(uav);
  if (sensor >= world_.uavs[uav].sensors.size()) {
    broken_call("no sensor of index " + std::to_string(sensor));
  }
  ++calls_.measure;
  if (on_measure_) on_measure_(uav, sensor);

  const double* body = snapshot.state.data() + uav * kNumbersPerBody;
  const double yaw_rad = body[3];
  const Sensor& model = world_.uavs[uav].sensors[sensor];
  if (const auto* camera = std::get_if<CameraModel>(&model.model)) {
    const std::string instant = std::to_string(to_ns(snapshot.at));
    const RandomKey key{seed_, random_stream(world_.uavs[uav].name, model.name, instant), index};
    uav::CameraSample image = make_image(*camera, snapshot.at, index, key);
    image.knows_anchors = planned_seen_.has_value();
    image.seen_anchors = planned_seen_.value_or(std::vector<uav::SeenAnchor>{});
    return image;
  }
  if (const auto* range = std::get_if<RangeModel>(&model.model)) {
    return uav::RangeSample{snapshot.at, index,
                            range_ahead_m(*range, {body[0], body[1], body[2]}, yaw_rad)};
  }
  return uav::ImuSample{snapshot.at,
                        index,
                        {0.0, 0.0, body[7]},
                        {0.0, 0.0, world_.gravity_m_s2},
                        q_from_yaw(yaw_rad)};
}

GroundTruth FakeSimulator::ground_truth(std::size_t uav) const {
  check_uav(uav);
  const Body& body = bodies_[uav];
  const auto joints_rad = joints_.angles_rad(uav);
  return {now_,
          {body.p_WB,
           q_from_yaw(body.yaw_rad),
           velocity_W(body.yaw_rad, body.command),
           {0.0, 0.0, body.command.yaw_rate_rad_s}},
          {joints_rad.begin(), joints_rad.end()}};
}

void FakeSimulator::set_camera_kind(uav::CameraKind kind) {
  for (Uav& uav : world_.uavs) {
    for (Sensor& sensor : uav.sensors) {
      if (auto* camera = std::get_if<CameraModel>(&sensor.model)) camera->kind = kind;
    }
  }
}

std::vector<Contact> FakeSimulator::take_contacts() {
  std::vector<Contact> begun;
  while (planned_contacts_ && !planned_contacts_->empty() && planned_contacts_->front().at < now_) {
    begun.push_back(planned_contacts_->front());
    planned_contacts_->erase(planned_contacts_->begin());
  }
  return begun;
}

std::optional<Clearance> FakeSimulator::clearance(std::size_t uav) const {
  check_uav(uav);
  if (!planned_contacts_) return std::nullopt;
  return Clearance{kWallX_m - bodies_[uav].p_WB.x, "wall"};
}

SimTime instant_in_image(const uav::CameraSample& image) {
  std::uint64_t ns = 0;
  for (std::size_t i = 0; i < 8; ++i) ns |= std::uint64_t{image.rgb[i]} << (8 * i);
  return from_ns<SimTime>(static_cast<std::int64_t>(ns));
}

}  // namespace tether::sim
