#include <array>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <vector>

#include <benchmark/benchmark.h>

#include <tether/sim_raster/renderer.h>
#include <tether/sim_raster/scene.h>

// Pictures of a furnished, textured room with four lamps. `images` is how many there are for each
// second of CPU time.
namespace tether::raster {
namespace {

using uav::Pose;
using uav::Vec3;

Texture checks(int size_px) {
  Texture texture{size_px, size_px, {}};
  for (int y = 0; y < size_px; ++y) {
    for (int x = 0; x < size_px; ++x) {
      const int stain = (x * x + 3 * y * y + x * y) % 61;
      const bool is_dark = (x / 16 + y / 16) % 2 == 0;
      for (int i = 0; i < 3; ++i) {
        texture.rgba.push_back(static_cast<std::uint8_t>((is_dark ? 110 : 190) + stain - 7 * i));
      }
      texture.rgba.push_back(255);
    }
  }
  return texture;
}

void add_vertex(Mesh& mesh, const Vec3& p, const Vec3& n, double u, double v) {
  mesh.vertices.push_back(
      {{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)},
       {static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)},
       {static_cast<float>(u), static_cast<float>(v)}});
}

void add_square(Mesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  mesh.triangles.insert(mesh.triangles.end(), {{a, b, c}, {a, c, d}});
}

// A box of the given size around its origin, seen from outside, or from inside for side −1.
Mesh box(const Vec3& size, double side) {
  const std::array<double, 3> half{0.5 * size.x, 0.5 * size.y, 0.5 * size.z};
  Mesh mesh;
  for (std::size_t face = 0; face < 6; ++face) {
    const std::size_t axis = face / 2;
    const double sign = face % 2 == 0 ? 1.0 : -1.0;
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (int corner = 0; corner < 4; ++corner) {
      const double a = corner == 0 || corner == 3 ? -1.0 : 1.0;
      const double b = corner < 2 ? -1.0 : 1.0;
      std::array<double, 3> p{};
      std::array<double, 3> n{};
      p[axis] = sign * half[axis];
      p[(axis + 1) % 3] = side * sign * a * half[(axis + 1) % 3];
      p[(axis + 2) % 3] = b * half[(axis + 2) % 3];
      n[axis] = side * sign;
      add_vertex(mesh, {p[0], p[1], p[2]}, {n[0], n[1], n[2]}, (a + 1.0) * half[(axis + 1) % 3],
                 (b + 1.0) * half[(axis + 2) % 3]);
    }
    add_square(mesh, first, first + 1, first + 2, first + 3);
  }
  return mesh;
}

Mesh ball(double radius, int n) {
  constexpr double kPi = 3.141592653589793;
  Mesh mesh;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      const double polar = kPi * i / n;
      const double around = 2.0 * kPi * j / n;
      const Vec3 normal{std::sin(polar) * std::cos(around), std::sin(polar) * std::sin(around),
                        std::cos(polar)};
      add_vertex(mesh, radius * normal, normal, 1.0 * j / n, 1.0 * i / n);
    }
  }
  const auto stride = static_cast<std::uint32_t>(n + 1);
  for (std::uint32_t a = 0; a + stride + 1 < mesh.vertices.size(); ++a) {
    if (a % stride + 1 < stride) add_square(mesh, a, a + stride, a + stride + 1, a + 1);
  }
  return mesh;
}

Instance placed(std::size_t mesh, std::size_t material, const Vec3& p) {
  Instance instance;
  instance.mesh = mesh;
  instance.material = material;
  instance.X_BV.p = p;
  return instance;
}

// The room, with as many boxes as there are, and balls of 2·n² triangles each.
SceneParts room(int boxes, int balls, int n) {
  SceneParts parts;
  parts.textures = {checks(256), checks(128)};
  parts.meshes = {box({14.0, 5.0, 3.0}, -1.0), box({0.5, 0.4, 0.7}, 1.0), ball(0.3, n)};
  parts.materials.resize(3);
  parts.materials[0].texture = 0;
  parts.materials[1].texture = 1;
  parts.materials[2].specular = {0.4F, 0.4F, 0.4F};
  parts.instances.push_back(placed(0, 0, {5.0, 0.0, 0.0}));
  for (int i = 0; i < boxes; ++i) {
    parts.instances.push_back(placed(1, 1, {1.5 + 0.25 * i, i % 2 == 0 ? 1.9 : -1.8, -1.1}));
  }
  for (int i = 0; i < balls; ++i) {
    parts.instances.push_back(
        placed(2, 2, {2.0 + 0.6 * i, -1.5 + 1.1 * (i % 4), 0.5 - 0.4 * (i % 3)}));
  }
  for (int i = 0; i < 4; ++i) {
    Light lamp;
    lamp.p_WL = {3.0 * i, 0.0, 1.3};
    lamp.diffuse = {0.5F, 0.49F, 0.46F};
    lamp.specular = {0.15F, 0.15F, 0.14F};
    lamp.attenuation_constant = 0.55F;
    lamp.attenuation_linear = 0.1F;
    lamp.attenuation_quadratic = 0.06F;
    parts.lights.push_back(lamp);
  }
  return parts;
}

// Small: 500 triangles. Large: 11,000.
const Scene& scene(bool is_large) {
  static const Scene kSmall(room(36, 1, 6));
  static const Scene kLarge(room(36, 12, 21));
  return is_large ? kLarge : kSmall;
}

struct Options {
  int width_px = 640;
  int height_px = 480;
  bool is_large = false;
  double exposure_s = 0.0;
  double readout_s = 0.0;
  bool is_distorted = false;
  bool antialias = false;
  bool with_depth = false;
};

// A flight at 0.5 m/s that turns at 0.1 rad/s, with cameras side by side.
Pose camera_pose(double t_s, int camera = 0) {
  return Pose{{0.5 * t_s, 0.0, 0.0}, uav::from_axis_angle({0, 0, 1}, 0.1 * t_s)} *
         Pose{{0.0, -0.1 * camera, 0.0}, uav::q_body_from_optical()};
}

void images(benchmark::State& state, const Options& options) {
  Renderer renderer(scene(options.is_large));
  View view;
  view.camera = uav::CameraModel::from_horizontal_fov(options.width_px, options.height_px, 1.0472);
  if (options.is_distorted) {
    view.camera.k1 = -0.2;
    view.camera.k2 = 0.03;
  }
  view.exposure_s = options.exposure_s;
  view.readout_s = options.readout_s;
  view.spacing_s = 0.001;
  view.antialias = options.antialias;
  const auto pixels = static_cast<std::size_t>(options.width_px * options.height_px);
  std::vector<std::uint8_t> rgb(3 * pixels);
  std::vector<float> depth_m(options.with_depth ? pixels : 0);
  std::vector<std::uint32_t> entity(options.with_depth ? pixels : 0);
  Picture picture;
  picture.rgb = rgb;
  picture.depth_m = depth_m;
  picture.entity = entity;
  constexpr int kInstants = 31;
  std::vector<Instant> instants(options.exposure_s + options.readout_s > 0.0 ? kInstants : 1);
  int k = 0;
  for (auto _ : state) {
    for (std::size_t i = 0; i < instants.size(); ++i) {
      const double t = 0.033 * (k % 60) + 0.001 * static_cast<double>(i);
      instants[i].X_WC = camera_pose(t);
    }
    view.instants = instants;
    renderer.draw(view, picture);
    benchmark::DoNotOptimize(rgb.data());
    ++k;
  }
  state.SetLabel(Renderer::instructions());
  state.counters["images"] =
      benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

double cpu_s() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// Pictures of several cameras that one renderer draws in turn. `times_one` is how many times as
// long a picture takes as one of a single camera, which another renderer draws in between.
void cameras(benchmark::State& state, int count) {
  Renderer single(scene(false));
  Renderer several(scene(false));
  View view;
  view.camera = uav::CameraModel::from_horizontal_fov(640, 480, 1.0472);
  std::vector<std::uint8_t> rgb(std::size_t{3} * 640 * 480);
  Picture picture;
  picture.rgb = rgb;
  const auto draw = [&](Renderer& renderer, double t_s, int camera) {
    const Instant instant{camera_pose(t_s, camera), {}};
    view.instants = {&instant, 1};
    const double begin_s = cpu_s();
    renderer.draw(view, picture);
    return cpu_s() - begin_s;
  };
  double one_s = 0.0;
  double all_s = 0.0;
  int k = 0;
  for (auto _ : state) {
    const double t_s = 0.033 * (k++ % 60);
    for (int camera = 0; camera < count; ++camera) {
      one_s += draw(single, t_s, 0);
      all_s += draw(several, t_s, camera);
    }
  }
  state.counters["times_one"] = all_s / one_s;
}

const Options kPlain{};
const Options kSmallImage{320, 240};
const Options kLarge{640, 480, true};
const Options kLargeSmallImage{320, 240, true};
const Options kRolling{640, 480, false, 0.0, 0.020};
const Options kExposed{640, 480, false, 0.010, 0.020};
const Options kLargeExposed{640, 480, true, 0.010, 0.020};
const Options kDistorted{640, 480, false, 0.0, 0.0, true};
const Options kDistortedExposed{640, 480, false, 0.010, 0.020, true};
const Options kAntialiased{640, 480, false, 0.0, 0.0, false, true};
const Options kWithDepth{640, 480, false, 0.0, 0.0, false, false, true};

BENCHMARK_CAPTURE(images, 640x480, kPlain)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(images, 320x240, kSmallImage)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(images, 640x480_11000_triangles, kLarge)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(images, 320x240_11000_triangles, kLargeSmallImage)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(images, rolling_20ms, kRolling)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(images, exposed_10ms_rolling_20ms, kExposed)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(images, exposed_10ms_rolling_20ms_11000_triangles, kLargeExposed)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(images, distorted, kDistorted)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(images, distorted_exposed_10ms_rolling_20ms, kDistortedExposed)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(images, antialiased, kAntialiased)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(images, with_depth_and_entities, kWithDepth)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(cameras, stereo_pair, 2)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(cameras, four, 4)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace tether::raster
