#include <tether/sim_testing/test_worlds.h>

namespace tether::sim::testing {

Visual box_visual(const uav::Vec3& size_m, const uav::Vec3& rgb) {
  Visual visual{"box", {}, BoxGeometry{size_m}, {}, true};
  visual.material.diffuse_rgb = visual.material.ambient_rgb = rgb;
  return visual;
}

Collision box_collision(const uav::Vec3& size_m) {
  return {"box", {}, BoxGeometry{size_m}, 1.0};
}

Model box_model(const std::string& name, const uav::Vec3& p_WM, const uav::Vec3& size_m,
                const uav::Vec3& rgb, bool is_static) {
  Model model{name, {p_WM, {}}, is_static, {{}}};
  model.links[0].visuals.push_back(box_visual(size_m, rgb));
  model.links[0].collisions.push_back(box_collision(size_m));
  return model;
}

uav::CameraModel camera_intrinsics(int width_px, int height_px) {
  return uav::CameraModel::from_horizontal_fov(width_px, height_px, 1.2);
}

Sensor camera_sensor(const std::string& name, int width_px, int height_px) {
  CameraModel model;
  model.intrinsics = camera_intrinsics(width_px, height_px);
  return {name, {{0.2, 0.0, 0.0}, {}}, 0.0, model};
}

Uav test_uav(const std::string& name, const uav::Vec3& p_WB) {
  Uav uav;
  uav.name = name;
  uav.X_WB.p = p_WB;
  uav.airframe = uav::hummingbird();
  uav.body.name = "body";
  uav.body.visuals.push_back(box_visual({0.4, 0.4, 0.1}, {0.2, 0.2, 0.2}));
  uav.body.collisions.push_back(box_collision({0.4, 0.4, 0.1}));
  uav.sensors = {camera_sensor("camera", 160, 120),
                 {"imu", {}, 0.0, ImuModel{}},
                 {"range", {}, 0.0, RangeModel{}}};
  return uav;
}

World test_world() {
  World world;
  world.name = "test";
  world.models.push_back(box_model("floor", {0.0, 0.0, -0.05}, {20.0, 20.0, 0.1}, {0.5, 0.5, 0.5}));
  world.uavs.push_back(test_uav("alpha", {0.0, 0.0, 1.0}));
  return world;
}

World world_with_battery(double charge, double resistance_ohm) {
  World world = test_world();
  energy::Model& model = world.uavs[0].energy.emplace();
  model.propulsion = {.rotor_radius_m = 0.1, .efficiency = 0.7, .nominal_voltage_V = 11.1};
  model.battery = {.capacity_C = 7560.0,
                   .voltage_at_charge = {{0.0, 10.0}, {1.0, 12.6}},
                   .resistance_ohm = resistance_ohm,
                   .cut_off_V = 5.0,
                   .initial_charge = charge};
  return world;
}

}  // namespace tether::sim::testing
