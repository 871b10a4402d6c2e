#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <tether/sim_protocol/messages.h>

namespace tether::sim::protocol {

/// Every field of a message in order, to compare messages. Structured bindings make a field that is
/// missing here a compile error.
class Fields {
 public:
  explicit Fields(const Request& request) {
    std::visit([this](const auto& r) { add(r); }, request);
  }
  explicit Fields(const Reply& reply) {
    std::visit([this](const auto& r) { add(r); }, reply);
  }
  friend bool operator==(const Fields&, const Fields&) = default;

 private:
  template <class... T>
  void all(const T&... values) {
    (add(values), ...);
  }
  void add(double value) { numbers_.push_back(value); }
  void add(const std::string& value) { texts_.push_back(value); }
  void add(Duration value) { add(static_cast<double>(value.count())); }
  void add(SimTime value) { add(value.time_since_epoch()); }
  template <class T>
  void add(const std::optional<T>& value) {
    add(value ? static_cast<double>(*value) : -1.0);
  }
  template <class T>
  void add(const std::vector<T>& values) {
    add(static_cast<double>(values.size()));
    for (const T& value : values) add(value);
  }

  void add(const uav::Vec3& v) { all(v.x, v.y, v.z); }
  void add(const uav::Quat& q) { all(q.w, q.x, q.y, q.z); }
  void add(const uav::Pose& X) { all(X.p, X.q); }
  void add(const uav::BodyState& s) { all(s.p_WB, s.q_WB, s.v_WB, s.w_WB_B); }
  void add(const uav::Rotor& r) { all(r.p_BR, r.direction); }
  void add(const uav::MultirotorParameters& airframe) {
    const auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p] = airframe;
    all(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p);
  }
  void add(const uav::CameraModel& camera) {
    const auto& [a, b, c, d, e, f, g, h, i, j, k] = camera;
    all(a, b, c, d, e, f, g, h, i, j, k);
  }
  void add(const Motion& m) { all(m.a_WB_W, m.alpha_WB_B); }
  void add(const Command& c) { all(c.uav, c.command.velocity_H_m_s, c.command.yaw_rate_rad_s); }
  void add(const UavDescription& u) { all(u.name, u.sdf, u.X_WB, u.airframe); }
  void add(const BodyName& b) { all(b.model, b.link); }
  void add(const VisualMaterial& material) {
    const auto& [a, b, c, d, e, f, g, h, i, j, k] = material;
    all(a, b, c, d, e, f, g, h, i, j, k);
  }

  void add(const Open& open) {
    const auto& [a, b, c, d, e, f, g, h, i, j, k] = open;
    all(a, b, c, d, e, f, g, h, i, j, k);
  }
  void add(const Reset& reset) { add(std::to_string(reset.seed)); }
  void add(const Advance& advance) { all(advance.to, advance.commands); }
  void add(const CastRays& c) { all(c.X_WB, c.carrier, c.X_WS, c.rays_S, c.max_m); }
  void add(const Render& render) {
    const auto& [a, b, c, d, e, f, g] = render;
    all(a, b, c, d, e, f, g);
  }
  void add(const Touch& touch) {
    const auto& [a, b, c, d, e] = touch;
    all(a, b, c, d, e);
  }
  void add(const State& state) {
    const auto& [a, b, c, d, e] = state;
    all(a, b, c, d, e);
  }
  void add(const Opened& opened) {
    const auto& [a, b, c] = opened;
    all(a, b, c);
  }
  void add(const Distances& d) { add(d.distance_m); }
  void add(const Picture& p) { all(p.width_px, p.height_px, p.rgb, p.nearest_depth_m, p.renderer); }
  void add(const Failed& f) { add(f.message); }

  std::vector<double> numbers_;
  std::vector<std::string> texts_;
};

}  // namespace tether::sim::protocol
