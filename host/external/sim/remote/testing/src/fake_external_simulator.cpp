#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include <sys/socket.h>

#include <tether/link/socket.h>
#include <tether/sim/bodies.h>
#include <tether/sim_protocol/codec.h>
#include <tether/sim_remote_testing/fake_external_simulator.h>

namespace tether::sim::testing {

using namespace protocol;
using uav::Pose;
using uav::Vec3;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// With which UAVs approach their commanded velocity.
constexpr double kTimeConstant_s = 0.2;

/// Where a ray enters a box about the origin; infinite if it misses the box or begins in it.
double entry_m(const Vec3& origin, const Vec3& ray, const Vec3& half_m) {
  double first = -kInfinity;
  double last = kInfinity;
  for (const double Vec3::*axis : {&Vec3::x, &Vec3::y, &Vec3::z}) {
    const double at = origin.*axis, along = ray.*axis, half = half_m.*axis;
    if (along == 0.0 && std::abs(at) > half) return kInfinity;
    if (along == 0.0) continue;
    const auto [near, far] = std::minmax({(-half - at) / along, (half - at) / along});
    first = std::max(first, near);
    last = std::min(last, far);
  }
  return first > last || first < 0.0 ? kInfinity : first;
}

}  // namespace

FakeExternalSimulator::FakeExternalSimulator(const World& world, Fault fault)
    : world_(world), fault_(std::move(fault)) {
  for (const FixedBody& body : fixed_bodies(world_)) add_boxes(*body.link, std::nullopt, body.X_WB);
  const std::vector<MovingBody> moving = moving_bodies(world_);
  for (std::size_t i = 0; i < moving.size(); ++i) add_boxes(*moving[i].link, i, {});
  link::Descriptor listening = link::listen_on_tcp({"127.0.0.1", 0}).value();
  const Endpoint address = link::local_address(listening.get());
  connection_ = connect(address, std::chrono::seconds(30)).value();
  thread_ = std::thread([this, socket = std::move(listening)] { serve(socket.get()); });
}

FakeExternalSimulator::~FakeExternalSimulator() {
  if (connection_) connection_->close();
  thread_.join();
}

std::vector<Request> FakeExternalSimulator::requests() const {
  const std::lock_guard lock(mutex_);
  return requests_;
}

void FakeExternalSimulator::serve(int listening) {
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
    std::optional<Reply> reply = std::visit([this](const auto& r) { return answer(r); }, *request);
    if (fault_) reply = fault_(*request, std::move(*reply));
    if (!reply || !socket.send(encoder.encode(*reply))) return;
  }
}

// ---- motion ------------------------------------------------------------------------------------

Reply FakeExternalSimulator::answer(const Open& open) {
  open_ = open;
  answer(Reset{});
  return Opened{"Fake 1.0", state()};
}

Reply FakeExternalSimulator::answer(const Reset&) {
  now_ = SimTime{};
  past_.clear();
  flights_.clear();
  for (const UavDescription& uav : open_.uavs) {
    flights_.push_back({{uav.X_WB.p, uav.X_WB.q, {}, {}}, {}, {}});
  }
  return state();
}

Reply FakeExternalSimulator::answer(const Advance& advance) {
  for (const Command& command : advance.commands) {
    flights_[command.uav].command = command.command;
  }
  past_.clear();
  for (; now_ < advance.to; now_ += open_.step) {
    if ((advance.to - now_) / open_.step <= open_.past_steps) {
      for (const uav::BodyState& body : state().bodies) past_.push_back({body.p_WB, body.q_WB});
    }
    for (Flight& flight : flights_) step(flight);
  }
  return state();
}

void FakeExternalSimulator::step(Flight& flight) const {
  uav::BodyState& body = flight.body;
  const double dt_s = to_seconds(open_.step);
  const Vec3 wanted_W = rotate(body.q_WB, flight.command.velocity_H_m_s);
  const double wanted_rad_s = flight.command.yaw_rate_rad_s;
  flight.motion.a_WB_W = (1.0 / kTimeConstant_s) * (wanted_W - body.v_WB);
  flight.motion.alpha_WB_B = {0.0, 0.0, (wanted_rad_s - body.w_WB_B.z) / kTimeConstant_s};
  body.v_WB = body.v_WB + dt_s * flight.motion.a_WB_W;
  body.w_WB_B = body.w_WB_B + dt_s * flight.motion.alpha_WB_B;
  body.p_WB = body.p_WB + dt_s * body.v_WB;
  body.q_WB = body.q_WB * uav::from_axis_angle({0.0, 0.0, 1.0}, dt_s * body.w_WB_B.z);
}

State FakeExternalSimulator::state() const {
  State state{now_, {}, {}, past_};
  for (const Flight& flight : flights_) {
    state.bodies.push_back(flight.body);
    state.motions.push_back(flight.motion);
  }
  const std::vector<MovingBody> moving = moving_bodies(world_);
  const double angle_rad = 2.0 * to_seconds(now_);
  for (std::size_t i = flights_.size(); i < moving.size(); ++i) {
    const Pose& X_WB = moving[i].X_WB;
    state.bodies.push_back({X_WB.p + Vec3{0.2 * std::sin(angle_rad), 0.0, 0.0},
                            X_WB.q,
                            {0.4 * std::cos(angle_rad), 0.0, 0.0},
                            {}});
  }
  return state;
}

// ---- measurements ------------------------------------------------------------------------------

void FakeExternalSimulator::add_boxes(const Link& link, std::optional<std::size_t> body,
                                      const Pose& X_WL) {
  for (const Collision& collision : link.collisions) {
    const auto* box = std::get_if<BoxGeometry>(&collision.geometry);
    if (box) boxes_.push_back({body, X_WL * collision.X_LC, 0.5 * box->size_m});
  }
}

double FakeExternalSimulator::distance_m(const Vec3& origin_W, const Vec3& ray_W,
                                         std::span<const Pose> X_WB,
                                         std::optional<std::uint32_t> without) const {
  double nearest_m = kInfinity;
  for (const Box& box : boxes_) {
    if (without && box.body == *without) continue;
    const Pose X_XW = inverse(box.body ? X_WB[*box.body] * box.X : box.X);
    nearest_m =
        std::min(nearest_m, entry_m(transform(X_XW, origin_W), rotate(X_XW.q, ray_W), box.half_m));
  }
  return nearest_m;
}

Reply FakeExternalSimulator::answer(const CastRays& cast) {
  Distances distances;
  for (const Vec3& ray_S : cast.rays_S) {
    distances.distance_m.push_back(
        distance_m(cast.X_WS.p, rotate(cast.X_WS.q, ray_S), cast.X_WB, cast.carrier));
  }
  return distances;
}

/// The farther, the lighter.
Reply FakeExternalSimulator::answer(const Render& render) {
  Picture picture{render.camera.width_px, render.camera.height_px, {}, render.far_m, "boxes"};
  const uav::Quat q_WC = render.X_WS.q * uav::q_body_from_optical();
  for (int row = 0; row < picture.height_px; ++row) {
    for (int column = 0; column < picture.width_px; ++column) {
      const Vec3 ray_C = render.camera.unproject({double(column), double(row)});
      const double m = distance_m(render.X_WS.p, rotate(q_WC, (1.0 / norm(ray_C)) * ray_C),
                                  render.X_WB, render.hidden);
      picture.rgb.insert(picture.rgb.end(), 3,
                         static_cast<std::uint8_t>(255.0 * (1.0 - std::exp(-0.2 * m))));
      picture.nearest_depth_m = std::min(picture.nearest_depth_m, m / norm(ray_C));
    }
  }
  return picture;
}

}  // namespace tether::sim::testing
