#pragma once

#include <limits>
#include <string>
#include <vector>

#include <tether/base/random.h>
#include <tether/sim_protocol/messages.h>

namespace tether::sim::protocol {

/// Draws valid messages of every kind, edges included, from keyed randomness.
class RandomMessage {
 public:
  explicit RandomMessage(std::uint64_t index) : random_({17, 1, index}) {}

  Request request() { return request(random_.bits() % 5); }
  Request request(std::uint32_t kind) {
    switch (kind) {
      case 0:
        return open();
      case 1:
        return Reset{word()};
      case 2:
        return Advance{
            time(), many<Command>([this] {
              return Command{random_.bits() % 1024, {vec3(), number()}};
            }),
            many<SetpointCommand>([this] {
              return SetpointCommand{
                  random_.bits() % 1024,
                  {.mask = uav::kAttitude | uav::kThrust, .q_WB = quat(), .thrust_N = 5}};
            })};
      case 3:
        return cast_rays();
      default:
        return render();
    }
  }

  Reply reply() { return reply(random_.bits() % 5); }
  Reply reply(std::uint32_t kind) {
    switch (kind) {
      case 0:
        return Opened{text(), state(), coin(), coin()};
      case 1:
        return state();
      case 2:
        return Distances{many<double>(
            [this] { return coin() ? number() : std::numeric_limits<double>::infinity(); })};
      case 3:
        return picture();
      default:
        return Failed{text()};
    }
  }

 private:
  bool coin() { return random_.bits() % 2 == 0; }
  double number() { return 50.0 * random_.uniform(); }
  double positive() { return 0.01 + number(); }
  uav::Vec3 vec3() { return {number() - 25.0, number(), -number()}; }
  uav::Vec3 color() { return {random_.uniform(), random_.uniform(), random_.uniform()}; }
  uav::Quat quat() { return uav::from_rpy(number(), number(), number()); }
  uav::Pose pose() { return {vec3(), quat()}; }
  std::uint64_t word() { return std::uint64_t{random_.bits()} << 32 | random_.bits(); }
  SimTime time() { return from_ns<SimTime>(static_cast<std::int64_t>(word() >> 2)); }
  std::string text() {
    std::string out(random_.bits() % 40, '\0');
    for (char& c : out) c = static_cast<char>(1 + random_.bits() % 255);
    return out;
  }
  template <class T, class Draw>
  std::vector<T> many(Draw draw) {
    std::vector<T> out(random_.bits() % 5);
    for (T& value : out) value = draw();
    return out;
  }
  std::optional<std::uint32_t> one_of(std::size_t count) {
    if (count == 0 || coin()) return std::nullopt;
    return static_cast<std::uint32_t>(random_.bits() % count);
  }

  uav::MultirotorParameters airframe() {
    uav::MultirotorParameters p = uav::hummingbird();
    using P = uav::MultirotorParameters;
    for (const auto member :
         {&P::mass_kg, &P::thrust_coefficient, &P::moment_coefficient_m, &P::drag_coefficient,
          &P::linear_drag_N_s_m, &P::max_rotor_speed_rad_s, &P::time_constant_up_s,
          &P::time_constant_down_s, &P::max_tilt_rad, &P::max_horizontal_speed_m_s,
          &P::max_vertical_speed_m_s, &P::max_yaw_rate_rad_s, &P::max_acceleration_m_s2,
          &P::max_yaw_acceleration_rad_s2}) {
      p.*member = positive();
    }
    p.inertia_kg_m2 = {positive(), positive(), positive()};
    p.rotors.push_back({vec3(), coin() ? 1 : -1});
    return p;
  }
  Open open() {
    const std::int32_t side_px = 1 + static_cast<std::int32_t>(random_.bits() % 4000);
    Open out;
    out.version = random_.bits();
    out.world_name = text();
    out.world_file = text();
    out.gravity_m_s2 = positive();
    out.step = Duration(1 + random_.bits() % 1000000);
    out.past_steps = random_.bits() % 1000;
    out.max_width_px = side_px;
    out.max_height_px = side_px / 2;
    out.uavs = many<UavDescription>([this] {
      return UavDescription{"u" + text(), text(), pose(), airframe()};
    });
    out.bodies = many<BodyName>([this] { return BodyName{text(), text()}; });
    out.materials = many<VisualMaterial>([this] {
      return VisualMaterial{text(),  text(), text(),     color(),    color(),  color(),
                            color(), text(), positive(), positive(), color().x};
    });
    return out;
  }
  CastRays cast_rays() {
    CastRays out;
    out.X_WB = many<uav::Pose>([this] { return pose(); });
    out.carrier = one_of(out.X_WB.size());
    out.X_WS = pose();
    out.rays_S = many<uav::Vec3>([this] { return uav::rotate(quat(), {1.0, 0.0, 0.0}); });
    out.rays_S.push_back({0.0, 1.0, 0.0});
    out.max_m = positive();
    return out;
  }
  Render render() {
    Render out;
    out.camera.width_px = 1 + static_cast<int>(random_.bits() % 4096);
    out.camera.height_px = 1 + static_cast<int>(random_.bits() % 4096);
    out.camera.fx_px = out.camera.fy_px = positive();
    out.camera.cx_px = -number();
    out.camera.cy_px = number();
    out.near_m = positive();
    out.far_m = out.near_m + positive();
    out.X_WS = pose();
    out.X_WB = many<uav::Pose>([this] { return pose(); });
    out.hidden = one_of(out.X_WB.size());
    out.with_depth = coin();
    return out;
  }
  State state() {
    State out;
    out.now = time();
    out.bodies = many<uav::BodyState>([this] {
      return uav::BodyState{vec3(), quat(), vec3(), vec3()};
    });
    out.motions.assign(out.bodies.size(), {vec3(), vec3()});
    out.past = many<uav::Pose>([this] { return pose(); });
    out.touches = many<Touch>([this] {
      return Touch{time(), random_.bits() % 1024, "t" + text(), random_.bits(), number() - 25.0};
    });
    return out;
  }
  Picture picture() {
    Picture out{1 + static_cast<int>(random_.bits() % 20),
                1 + static_cast<int>(random_.bits() % 20),
                {},
                number(),
                text()};
    out.rgb.resize(static_cast<std::size_t>(3 * out.width_px * out.height_px));
    for (auto& byte : out.rgb) byte = static_cast<std::uint8_t>(random_.bits());
    return out;
  }

  KeyedRandom random_;
};

/// The whole frame in one piece: a heap block of exactly its size, so that the address sanitizer
/// sees any read outside.
template <class Message, class AnyEncoder>
std::vector<std::uint8_t> frame_of(AnyEncoder& encoder, const Message& message) {
  const auto pieces = encoder.encode(message);
  std::vector<std::uint8_t> out;
  out.reserve(pieces.size());
  for (const auto piece : {pieces.head, pieces.image, pieces.tail}) {
    out.insert(out.end(), piece.begin(), piece.end());
  }
  return out;
}

}  // namespace tether::sim::protocol
