#include <cmath>
#include <limits>
#include <utility>
#include <variant>

#include <sys/socket.h>

#include <tether/link/frame_socket.h>
#include <tether/link/socket.h>
#include <tether/sim/bodies.h>
#include <tether/sim_protocol/codec.h>
#include <tether/sim_remote_testing/fake_outside.h>

namespace tether::sim::testing {

using namespace protocol;
using uav::Pose;
using uav::Vec3;

namespace {

std::uint8_t to_byte(double part) {
  return static_cast<std::uint8_t>(std::lround(255.0 * part));
}

/// The rotation after turning with a constant angular velocity.
uav::Quat turned(const uav::Quat& q_WB, const Vec3& w_WB_B, double dt_s) {
  const double rate_rad_s = norm(w_WB_B);
  if (rate_rad_s == 0.0) return q_WB;
  return normalized(q_WB * uav::from_axis_angle((1.0 / rate_rad_s) * w_WB_B, rate_rad_s * dt_s));
}

}  // namespace

// ---- serving
// -----------------------------------------------------------------------------------

FakeOutside::FakeOutside(const World& world, Fault fault)
    : world_(world), scene_(world_), fault_(std::move(fault)) {
  link::Descriptor listening = link::listen_on_tcp({"127.0.0.1", 0}).value();
  const Endpoint address = link::local_address(listening.get());
  connection_ = connect(address, std::chrono::seconds(30)).value();
  thread_ = std::thread([this, socket = std::move(listening)] { serve(socket.get()); });
}

FakeOutside::~FakeOutside() {
  if (connection_) connection_->close();
  thread_.join();
}

std::vector<Request> FakeOutside::requests() const {
  const std::lock_guard lock(mutex_);
  return requests_;
}

void FakeOutside::serve(int listening) {
  link::FrameSocket socket(link::Descriptor(::accept(listening, nullptr, nullptr)), "the host",
                           kMaxFrameBytes);
  Encoder encoder;
  while (true) {
    const auto frame = socket.receive();
    if (!frame) return;
    const auto request = decode_request(*frame);
    if (!request) return;
    {
      const std::lock_guard lock(mutex_);
      requests_.push_back(*request);
    }
    std::optional<Reply> reply = answer(*request);
    if (fault_) reply = fault_(*request, std::move(*reply));
    if (!reply || !socket.send(encoder.encode(*reply))) return;
  }
}

Reply FakeOutside::answer(const Request& request) {
  return std::visit([this](const auto& r) { return answer(r); }, request);
}

Reply FakeOutside::answer(const Open& open) {
  open_ = open;
  answer(Reset{});
  return Opened{"Fake 1.0", state()};
}

// ---- motion
// ------------------------------------------------------------------------------------

Reply FakeOutside::answer(const Reset&) {
  now_ = SimTime{};
  past_.clear();
  flights_.clear();
  for (const UavDescription& uav : open_.uavs) {
    flights_.push_back({{uav.X_WB.p, uav.X_WB.q, {}, {}},
                        hover_state(uav.airframe, open_.gravity_m_s2, yaw_rad(uav.X_WB.q)),
                        {},
                        {}});
  }
  return state();
}

Reply FakeOutside::answer(const Advance& advance) {
  for (const Command& command : advance.commands) {
    flights_[command.uav].command = command.command;
  }
  past_.clear();
  while (now_ < advance.to) {
    if ((advance.to - now_) / open_.step <= open_.past_steps) {
      for (const uav::BodyState& body : state().bodies) past_.push_back({body.p_WB, body.q_WB});
    }
    step();
  }
  return state();
}

void FakeOutside::step() {
  for (std::size_t i = 0; i < flights_.size(); ++i) step(i);
  now_ += open_.step;
}

void FakeOutside::step(std::size_t uav) {
  Flight& flight = flights_[uav];
  const uav::MultirotorParameters& airframe = open_.uavs[uav].airframe;
  uav::BodyState& body = flight.body;
  const uav::Wrench wrench =
      uav::step(airframe, open_.gravity_m_s2, body, flight.command, open_.step, flight.rotors);
  const Vec3& i = airframe.inertia_kg_m2;
  const Vec3& w = body.w_WB_B;
  const Vec3 torque_B = wrench.torque_B - cross(w, {i.x * w.x, i.y * w.y, i.z * w.z});
  flight.motion.a_WB_W = (1.0 / airframe.mass_kg) * rotate(body.q_WB, wrench.force_B) -
                         Vec3{0.0, 0.0, open_.gravity_m_s2};
  flight.motion.alpha_WB_B = {torque_B.x / i.x, torque_B.y / i.y, torque_B.z / i.z};
  const double dt_s = to_seconds(open_.step);
  body.v_WB = body.v_WB + dt_s * flight.motion.a_WB_W;
  body.w_WB_B = body.w_WB_B + dt_s * flight.motion.alpha_WB_B;
  body.p_WB = body.p_WB + dt_s * body.v_WB;
  body.q_WB = turned(body.q_WB, body.w_WB_B, dt_s);
}

uav::BodyState FakeOutside::swinging(std::size_t body) const {
  const Pose X_WB = moving_bodies(world_)[body].X_WB;
  const double angle_rad = 2.0 * to_seconds(now_);
  return {X_WB.p + Vec3{0.2 * std::sin(angle_rad), 0.0, 0.0},
          X_WB.q,
          {0.4 * std::cos(angle_rad), 0.0, 0.0},
          {}};
}

State FakeOutside::state() const {
  State state;
  state.now = now_;
  for (const Flight& flight : flights_) {
    state.bodies.push_back(flight.body);
    state.motions.push_back(flight.motion);
  }
  for (std::size_t i = 0; i < open_.bodies.size(); ++i) {
    state.bodies.push_back(swinging(flights_.size() + i));
  }
  state.past = past_;
  return state;
}

// ---- measurements
// ------------------------------------------------------------------------------

Reply FakeOutside::answer(const CastRays& cast) {
  Distances distances;
  for (const Vec3& ray_S : cast.rays_S) {
    const auto hit =
        scene_.first_hit(cast.X_WS.p, rotate(cast.X_WS.q, ray_S), cast.X_WB, cast.carrier, false);
    distances.distance_m.push_back(hit ? hit->distance_m : std::numeric_limits<double>::infinity());
  }
  return distances;
}

Reply FakeOutside::answer(const Render& render) {
  Picture picture{render.camera.width_px, render.camera.height_px, {}, render.far_m, "boxes"};
  const uav::Quat q_WC = render.X_WS.q * uav::q_body_from_optical();
  for (int row = 0; row < picture.height_px; ++row) {
    for (int column = 0; column < picture.width_px; ++column) {
      const Vec3 ray_C = render.camera.unproject({double(column), double(row)});
      const Vec3 ray_W = rotate(q_WC, (1.0 / norm(ray_C)) * ray_C);
      const auto hit = scene_.first_hit(render.X_WS.p, ray_W, render.X_WB, render.hidden, true);
      const Vec3 rgb = hit ? hit->rgb : world_.background_rgb;
      picture.rgb.insert(picture.rgb.end(), {to_byte(rgb.x), to_byte(rgb.y), to_byte(rgb.z)});
      if (hit) {
        picture.nearest_depth_m = std::min(picture.nearest_depth_m, hit->distance_m / norm(ray_C));
      }
    }
  }
  return picture;
}

}  // namespace tether::sim::testing
