#include "random_message.h"

#include <cmath>
#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/sim_protocol/codec.h>

namespace tether::sim::protocol {
namespace {

using ::testing::HasSubstr;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();
const uav::Quat kNotUnit{1.0, 0.0, 0.0, 0.01};

Open good_open() {
  Open open;
  open.step = std::chrono::milliseconds(1);
  open.uavs = {{"alpha", "<sdf/>", {}, uav::hummingbird()}};
  open.materials = {VisualMaterial{}};
  return open;
}
Advance good_advance() {
  return {from_ns<SimTime>(1'000'000), {{}}};
}
CastRays good_rays() {
  return {{{}}, {}, {}, {{1.0, 0.0, 0.0}}, 10.0};
}
Render good_render() {
  Render render;
  render.camera = uav::CameraModel::from_horizontal_fov(64, 48, 1.0);
  render.X_WB = {{}};
  return render;
}
State good_state() {
  return {SimTime{}, {{}}, {{}}, {{}}};
}
Picture good_picture() {
  return {2, 1, {1, 2, 3, 4, 5, 6}, 1.0, ""};
}

template <class Message>
struct Case {
  const char* field;
  std::function<void(Message&)> spoil;
};

template <class Any, class Message>
void expect_refused(const Message& good, const std::vector<Case<Message>>& cases) {
  ASSERT_TRUE(validate(Any(good)).ok()) << validate(Any(good)).failure().message;
  for (const auto& [field, spoil] : cases) {
    Message bad = good;
    spoil(bad);
    const Status status = validate(Any(bad));
    ASSERT_FALSE(status.ok()) << field;
    EXPECT_EQ(status.failure().kind, Failure::Kind::kInvalid);
    EXPECT_THAT(status.failure().message, HasSubstr(field));
  }
}

TEST(Validate, OpenIsSane) {
  expect_refused<Request, Open>(
      good_open(),
      {{"world_name", [](Open& o) { o.world_name = std::string(kMaxNameBytes + 1, 'x'); }},
       {"world_file", [](Open& o) { o.world_file = std::string("a\0b", 3); }},
       {"gravity_m_s2", [](Open& o) { o.gravity_m_s2 = kNaN; }},
       {"step", [](Open& o) { o.step = Duration(0); }},
       {"step", [](Open& o) { o.step = std::chrono::seconds(2); }},
       {"uavs, bodies", [](Open& o) { o.bodies.resize(kMaxBodies); }},
       {"past_steps", [](Open& o) { o.past_steps = kMaxPastPoses + 1; }},
       {"width_px", [](Open& o) { o.max_width_px = -1; }},
       {"width_px", [](Open& o) { o.max_width_px = o.max_height_px = kMaxSidePx; }},
       {"looks", [](Open& o) { o.materials.resize(kMaxMaterials + 1); }},
       {"diffuse_rgb", [](Open& o) { o.materials[0].diffuse_rgb.y = 1.5; }},
       {"texture_repeat_x", [](Open& o) { o.materials[0].texture_repeat_x = kInf; }},
       {"alpha", [](Open& o) { o.materials[0].alpha = 1.5; }}});
}

TEST(Validate, UavsAreSane) {
  expect_refused<Request, Open>(
      good_open(),
      {{"name", [](Open& o) { o.uavs[0].name.clear(); }},
       {"sdf", [](Open& o) { o.uavs[0].sdf = std::string(kMaxSdfBytes + 1, ' '); }},
       {"x_wb", [](Open& o) { o.uavs[0].X_WB.p.x = kNaN; }},
       {"x_wb", [](Open& o) { o.uavs[0].X_WB.q = kNotUnit; }},
       {"mass_kg", [](Open& o) { o.uavs[0].airframe.mass_kg = 0.0; }},
       {"inertia_kg_m2", [](Open& o) { o.uavs[0].airframe.inertia_kg_m2.z = kInf; }},
       {"rotors", [](Open& o) { o.uavs[0].airframe.rotors.clear(); }},
       {"rotors", [](Open& o) { o.uavs[0].airframe.rotors.resize(9); }},
       {"rotors", [](Open& o) { o.uavs[0].airframe.rotors[0].direction = 0; }},
       {"time_constant_up_s", [](Open& o) { o.uavs[0].airframe.time_constant_up_s = kNaN; }}});
}

TEST(Validate, AdvancesAreSane) {
  expect_refused<Request, Advance>(
      good_advance(),
      {{"to", [](Advance& a) { a.to = from_ns<SimTime>(-1); }},
       {"to", [](Advance& a) { a.to = SimTime::max(); }},
       {"commands", [](Advance& a) { a.commands[0].uav = kMaxBodies; }},
       {"commands", [](Advance& a) { a.commands[0].command.yaw_rate_rad_s = kNaN; }},
       {"commands", [](Advance& a) { a.commands.resize(kMaxBodies + 1); }},
       {"setpoints",
        [](Advance& a) {
          a.setpoints = {{kMaxBodies, {}}};
        }},
       {"setpoints", [](Advance& a) { a.setpoints.resize(kMaxBodies + 1); }},
       {"set-point", [](Advance& a) {
          a.setpoints = {{0, {.mask = 0}}};
        }}});
}

TEST(Validate, RaysAreSane) {
  expect_refused<Request, CastRays>(good_rays(),
                                    {{"x_wb", [](CastRays& c) { c.X_WB[0].q = kNotUnit; }},
                                     {"x_wb", [](CastRays& c) { c.X_WB.resize(kMaxBodies + 1); }},
                                     {"carrier", [](CastRays& c) { c.carrier = 1; }},
                                     {"x_ws", [](CastRays& c) { c.X_WS.p.z = kInf; }},
                                     {"rays_s", [](CastRays& c) { c.rays_S.clear(); }},
                                     {"rays_s", [](CastRays& c) { c.rays_S[0].y = 0.1; }},
                                     {"rays_s", [](CastRays& c) { c.rays_S[0].x = kNaN; }},
                                     {"max_m", [](CastRays& c) { c.max_m = 0.0; }}});
}

TEST(Validate, RendersAreSane) {
  expect_refused<Request, Render>(
      good_render(), {{"width_px", [](Render& r) { r.camera.width_px = 0; }},
                      {"width_px", [](Render& r) { r.camera.height_px = kMaxSidePx + 1; }},
                      {"focal_px", [](Render& r) { r.camera.fx_px = kNaN; }},
                      {"camera", [](Render& r) { r.camera.fy_px += 1.0; }},
                      {"camera", [](Render& r) { r.camera.k1 = 0.1; }},
                      {"cx_px", [](Render& r) { r.camera.cx_px = kInf; }},
                      {"near_m", [](Render& r) { r.near_m = 0.0; }},
                      {"far_m", [](Render& r) { r.far_m = r.near_m; }},
                      {"x_ws", [](Render& r) { r.X_WS.q.w = 0.0; }},
                      {"x_wb", [](Render& r) { r.X_WB[0].p.y = kNaN; }},
                      {"hidden", [](Render& r) { r.hidden = 5; }}});
}

TEST(Validate, StatesAreSane) {
  expect_refused<Reply, State>(good_state(),
                               {{"now", [](State& s) { s.now = from_ns<SimTime>(-1); }},
                                {"bodies", [](State& s) { s.bodies.resize(kMaxBodies + 1); }},
                                {"bodies", [](State& s) { s.bodies[0].p_WB.x = kNaN; }},
                                {"bodies", [](State& s) { s.bodies[0].q_WB = kNotUnit; }},
                                {"bodies", [](State& s) { s.bodies[0].v_WB.y = kInf; }},
                                {"bodies", [](State& s) { s.bodies[0].w_WB_B.z = kNaN; }},
                                {"motions", [](State& s) { s.motions.resize(2); }},
                                {"motions", [](State& s) { s.motions[0].a_WB_W.x = kNaN; }},
                                {"motions", [](State& s) { s.motions[0].alpha_WB_B.x = kNaN; }},
                                {"past", [](State& s) { s.past[0].q = kNotUnit; }},
                                {"past", [](State& s) { s.past.resize(kMaxPastPoses + 1); }},
                                {"touches",
                                 [](State& s) {
                                   s.touches = {{{}, 0, "", 0, 1.0}};
                                 }},
                                {"touches",
                                 [](State& s) {
                                   s.touches = {{{}, 0, "a", 0, kNaN}};
                                 }},
                                {"touches",
                                 [](State& s) {
                                   s.touches = {{from_ns<SimTime>(-1), 0, "a", 0, 1.0}};
                                 }},
                                {"touches", [](State& s) {
                                   s.touches.assign(kMaxTouches + 1, {{}, 0, "a", 0, 1.0});
                                 }}});
}

TEST(Validate, MeasurementsAreSane) {
  expect_refused<Reply, Distances>(
      Distances{{1.0, kInf, 0.0}},
      {{"distance_m", [](Distances& d) { d.distance_m[0] = kNaN; }},
       {"distance_m", [](Distances& d) { d.distance_m[0] = -0.1; }},
       {"distance_m", [](Distances& d) { d.distance_m.resize(kMaxRays + 1); }}});
  expect_refused<Reply, Picture>(
      good_picture(),
      {{"width_px", [](Picture& p) { p.width_px = 0; }},
       {"rgb", [](Picture& p) { p.rgb.pop_back(); }},
       {"rgb", [](Picture& p) { p.height_px = 2; }},
       {"nearest_depth_m", [](Picture& p) { p.nearest_depth_m = kNaN; }},
       {"renderer", [](Picture& p) { p.renderer.resize(kMaxTextBytes + 1, 'x'); }}});
}

}  // namespace
}  // namespace tether::sim::protocol
