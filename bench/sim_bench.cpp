#include "physics_model.h"
#include "scene.h"

#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <hwy/highway.h>
#include <mujoco/mujoco.h>

#include <tether/sim/world.h>
#include <tether/sim_mujoco/mujoco_simulator.h>
#include <tether/sim_raster/renderer.h>
#include <tether/sim_sdf/load_world.h>

// The embedded simulator in the corridor world: steps and images per second, each beside the least
// that the same work could cost in the same program.
namespace tether::sim {
namespace {

using namespace std::chrono_literals;

void print_warning(const Warning& warning) {
  std::fprintf(stderr, "%s\n", to_line(warning).c_str());
}

World load(const std::string& world) {
  const std::filesystem::path root = TETHER_SOURCE_DIR;
  WorldRequest request;
  request.world = root / "data/worlds" / (world + ".sdf");
  request.uavs = {{"alpha", root / "data/models/hummingbird/model.sdf", {0.0, 0.0, 1.2}, 0.0}};
  return load_world(request, print_warning);
}

World corridor() {
  return load("corridor");
}

std::size_t camera_of(const World& world) {
  const auto& sensors = world.uavs[0].sensors;
  std::size_t i = 0;
  while (sensors[i].kind() != uav::SensorKind::kCamera) ++i;
  return i;
}

void count_items(benchmark::State& state, const char* name, double per_iteration) {
  state.counters[name] = benchmark::Counter(per_iteration * static_cast<double>(state.iterations()),
                                            benchmark::Counter::kIsRate);
}

// The UAV flies to and fro under control, one simulated second an iteration.
void BM_steps_corridor(benchmark::State& state) {
  const auto simulator = make_mujoco_simulator(corridor(), print_warning);
  double speed = 0.5;
  for (auto _ : state) {
    simulator->apply(0, uav::to_setpoint({{speed, 0.0, 0.0}, 0.2}));
    simulator->advance_to(simulator->now() + 1s);
    speed = -speed;
  }
  count_items(state, "steps", 1000.0);
}
BENCHMARK(BM_steps_corridor);

// The yardstick: the engine alone with the same model, held up by a constant force.
void BM_steps_engine_alone(benchmark::State& state) {
  const World world = corridor();
  const ModelPtr model = make_physics_model(world, print_warning);
  const DataPtr data = make_data(*model);
  data->xfrc_applied[6 + 2] = world.uavs[0].airframe.mass_kg * world.gravity_m_s2;
  for (auto _ : state) {
    for (int i = 0; i < 1000; ++i) mj_step(model.get(), data.get());
  }
  count_items(state, "steps", 1000.0);
}
BENCHMARK(BM_steps_engine_alone);

// Instructions that may be used while this exists.
class Instructions {
 public:
  explicit Instructions(std::int64_t targets) { choose(targets); }
  ~Instructions() { choose(0); }
  Instructions(const Instructions&) = delete;
  Instructions& operator=(const Instructions&) = delete;

 private:
  static void choose(std::int64_t targets) {
    hwy::SetSupportedTargetsForTest(targets);
    hwy::GetChosenTarget().DeInit();
  }
};

// Scans of a 2D lidar along a flight; the yardstick is the engine's rays alone.
World with_lidar(World world) {
  ScanModel scan{{.columns = 1080,
                  .rows = 1,
                  .min_azimuth_rad = -2.356,
                  .max_azimuth_rad = 2.356,
                  .min_m = 0.1,
                  .max_m = 30.0},
                 0.0,
                 {}};
  scan.noise.stddev = 0.01;
  world.uavs[0].sensors.push_back({"lidar", {}, 40.0, scan});
  return world;
}

void BM_scans_1080(benchmark::State& state, const char* name) {
  const World world = with_lidar(load(name));
  const std::size_t lidar = world.uavs[0].sensors.size() - 1;
  const auto simulator = make_mujoco_simulator(world, print_warning);
  simulator->apply(0, uav::to_setpoint({{0.5, 0.0, 0.0}, 0.1}));
  Snapshot snapshot;
  std::uint64_t index = 0;
  for (auto _ : state) {
    state.PauseTiming();
    if (simulator->now() > SimTime(10s)) simulator->reset(1);
    simulator->advance_to(simulator->now() + 25ms);
    simulator->capture(snapshot);
    state.ResumeTiming();
    benchmark::DoNotOptimize(simulator->measure(snapshot, 0, lidar, index++));
  }
  count_items(state, "scans", 1.0);
}
BENCHMARK_CAPTURE(BM_scans_1080, bays, "bays");
BENCHMARK_CAPTURE(BM_scans_1080, corridor, "corridor");
BENCHMARK_CAPTURE(BM_scans_1080, gates, "gates");
BENCHMARK_CAPTURE(BM_scans_1080, pillars, "pillars");
BENCHMARK_CAPTURE(BM_scans_1080, room, "room");
BENCHMARK_CAPTURE(BM_scans_1080, yard, "yard");

void BM_rays_engine_alone_1080(benchmark::State& state) {
  const World world = corridor();
  const ModelPtr model = make_physics_model(world, print_warning);
  const DataPtr data = make_data(*model);
  mj_kinematics(model.get(), data.get());
  const mjtNum origin[3] = {0.0, 0.0, 1.2};
  for (auto _ : state) {
    for (int i = 0; i < 1080; ++i) {
      const double azimuth_rad = 0.00436 * (i - 540);
      const mjtNum direction[3] = {std::cos(azimuth_rad), std::sin(azimuth_rad), 0.0};
      int geom = -1;
      benchmark::DoNotOptimize(
          mj_ray(model.get(), data.get(), origin, direction, nullptr, 1, 1, &geom));
    }
  }
  count_items(state, "scans", 1.0);
}
BENCHMARK(BM_rays_engine_alone_1080);

// Images along a flight down the corridor, noise and all. `targets`: the processor's instructions
// that may be used; 0: all. `helpers`: threads that help to draw.
void images(benchmark::State& state, int width_px, int height_px, std::int64_t targets,
            int helpers = 0) {
  const Instructions instructions(targets);
  World world = corridor();
  const std::size_t camera = camera_of(world);
  auto& model = std::get<CameraModel>(world.uavs[0].sensors[camera].model);
  model.intrinsics = uav::CameraModel::from_horizontal_fov(width_px, height_px,
                                                           model.intrinsics.horizontal_fov_rad());
  const auto simulator = make_mujoco_simulator(world, print_warning, helpers);
  simulator->apply(0, uav::to_setpoint({{0.5, 0.0, 0.0}, 0.1}));
  Snapshot snapshot;
  simulator->capture(snapshot);
  simulator->measure(snapshot, 0, camera, 0);  // sets the renderer up
  std::uint64_t index = 0;
  for (auto _ : state) {
    if (simulator->now() > SimTime(10s)) simulator->reset(1);
    simulator->advance_to(simulator->now() + 33ms);
    simulator->capture(snapshot);
    benchmark::DoNotOptimize(simulator->measure(snapshot, 0, camera, index++));
  }
  state.SetLabel(simulator->description() + ", " + raster::Renderer::instructions());
  count_items(state, "images", 1.0);
}
void BM_images_640x480(benchmark::State& state) {
  images(state, 640, 480, 0);
}
void BM_images_320x240(benchmark::State& state) {
  images(state, 320, 240, 0);
}
void BM_images_640x480_avx2(benchmark::State& state) {
  images(state, 640, 480, HWY_AVX2);
}
void BM_images_320x240_avx2(benchmark::State& state) {
  images(state, 320, 240, HWY_AVX2);
}
BENCHMARK(BM_images_640x480)->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);
BENCHMARK(BM_images_320x240)->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);
BENCHMARK(BM_images_640x480_avx2)->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);
BENCHMARK(BM_images_320x240_avx2)->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);

// The same images by wall time: on one thread, and with a thread that helps.
void BM_images_640x480_alone(benchmark::State& state) {
  images(state, 640, 480, 0);
}
void BM_images_640x480_helped(benchmark::State& state) {
  images(state, 640, 480, 0, 1);
}
BENCHMARK(BM_images_640x480_alone)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(BM_images_640x480_helped)->UseRealTime()->Unit(benchmark::kMillisecond);

// What shutter and lens cost: the images of two cameras in one place along the same flight, one
// with them and one without. `times_plain` is how many times the CPU time the one takes.
void effects(benchmark::State& state, double exposure_s, double readout_s, bool is_distorted) {
  World world = corridor();
  const std::size_t plain = camera_of(world);
  const std::size_t affected = world.uavs[0].sensors.size();
  Sensor copy = world.uavs[0].sensors[plain];
  copy.name = "affected";
  auto& model = std::get<CameraModel>(copy.model);
  model.exposure_s = exposure_s;
  model.readout_s = readout_s;
  if (is_distorted) model.intrinsics.k1 = -0.2, model.intrinsics.k2 = 0.03;
  world.uavs[0].sensors.push_back(copy);
  const auto simulator = make_mujoco_simulator(world, print_warning);
  Snapshot snapshot;
  std::uint64_t index = 0;
  const auto seconds = [&](std::size_t camera) {
    const std::clock_t begin = std::clock();
    benchmark::DoNotOptimize(simulator->measure(snapshot, 0, camera, index));
    return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  };
  const auto take_off = [&] {
    simulator->reset(1);
    simulator->apply(0, uav::to_setpoint({{0.5, 0.0, 0.0}, 0.1}));
    simulator->advance_to(SimTime(2s));
  };
  take_off();
  simulator->capture(snapshot);
  seconds(plain);  // sets the renderer up
  seconds(affected);
  double plain_s = 0.0;
  double affected_s = 0.0;
  for (auto _ : state) {
    if (simulator->now() > SimTime(5s)) take_off();  // before it meets the wall
    simulator->advance_to(simulator->now() + 33ms);
    simulator->capture(snapshot);
    plain_s += seconds(plain);
    affected_s += seconds(affected);
    ++index;
  }
  state.counters["times_plain"] = affected_s / plain_s;
}
// Whole flights: what an image costs depends on how near the wall is.
constexpr int kImages = 3 * 91;
BENCHMARK_CAPTURE(effects, exposed_10ms, 0.010, 0.0, false)->Iterations(kImages);
BENCHMARK_CAPTURE(effects, rolling_20ms, 0.0, 0.020, false)->Iterations(kImages);
BENCHMARK_CAPTURE(effects, exposed_10ms_rolling_20ms, 0.010, 0.020, false)->Iterations(kImages);
BENCHMARK_CAPTURE(effects, distorted, 0.0, 0.0, true)->Iterations(kImages);
BENCHMARK_CAPTURE(effects, distorted_exposed_10ms_rolling_20ms, 0.010, 0.020, true)
    ->Iterations(kImages);

// The yardsticks: the renderer alone with the same world from the start of that flight, without
// physics and noise, and with an empty world.
void renderer_alone(benchmark::State& state, const raster::SceneParts& parts, int width_px,
                    int height_px) {
  const raster::Scene scene(parts);
  raster::Renderer renderer(scene);
  const std::vector<uav::Pose> bodies(scene.bodies());
  const uav::Pose X_WS{{0.1, 0.0, 1.2}, {}};
  const raster::Instant instant{X_WS * uav::Pose{{}, uav::q_body_from_optical()}, bodies};
  raster::View view;
  view.camera = uav::CameraModel::from_horizontal_fov(width_px, height_px, 1.4);
  view.instants = {&instant, 1};
  std::vector<std::uint8_t> rgb(static_cast<std::size_t>(3 * width_px * height_px));
  raster::Picture picture;
  picture.rgb = rgb;
  for (auto _ : state) {
    renderer.draw(view, picture);
    benchmark::DoNotOptimize(rgb.data());
  }
  state.SetLabel(raster::Renderer::instructions());
  count_items(state, "images", 1.0);
}
void BM_renderer_alone_640x480(benchmark::State& state) {
  renderer_alone(state, make_scene(corridor(), print_warning), 640, 480);
}
void BM_renderer_alone_320x240(benchmark::State& state) {
  renderer_alone(state, make_scene(corridor(), print_warning), 320, 240);
}
void BM_empty_images_640x480(benchmark::State& state) {
  renderer_alone(state, {}, 640, 480);
}
void BM_empty_images_320x240(benchmark::State& state) {
  renderer_alone(state, {}, 320, 240);
}
BENCHMARK(BM_renderer_alone_640x480)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_renderer_alone_320x240)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_empty_images_640x480)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_empty_images_320x240)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace tether::sim
