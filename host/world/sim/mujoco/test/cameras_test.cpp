#include "renderer.h"
#include "scene.h"
#include "test_simulator.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>

#include <tether/sim_sdf/load_world.h>
#include <tether/sim_sensing/view_renderer.h>

// Shutter and lens in images of the whole simulator.
namespace tether::sim {
namespace {

using testing::box_model;
using testing::kCamera;
using testing::make_simulator;
using testing::measure_now;
using testing::test_uav;
using uav::Vec3;

using namespace std::chrono_literals;

constexpr int kWidth = 320;
constexpr int kHeight = 240;
constexpr double kWall_m = 5.0;

// A world that shows colours unchanged.
World seen_world() {
  World world;
  world.ambient_rgb = {1.0, 1.0, 1.0};
  world.background_rgb = {0.0, 0.0, 0.0};
  world.uavs.push_back(test_uav("alpha", {0.0, 0.0, 1.0}));
  Sensor& sensor = world.uavs[0].sensors[kCamera];
  sensor = testing::camera_sensor("camera", kWidth, kHeight);
  sensor.X_BS = {};
  return world;
}

CameraModel& camera_of(World& world) {
  return std::get<CameraModel>(world.uavs[0].sensors[kCamera].model);
}

// Ahead, black from y = 0 to the left and white to the right: one upright edge. It is seen aslant,
// so that in a band of rows it lies anywhere within a pixel: a renderer's pixel is one point.
World edge_world() {
  World world = seen_world();
  world.models.push_back(
      box_model("right", {kWall_m + 0.5, -20.0, 0.0}, {1.0, 40.0, 40.0}, {1.0, 1.0, 1.0}));
  world.uavs[0].sensors[kCamera].X_BS.q = uav::from_rpy(0.1, 0.0, 0.0);
  return world;
}

World with_shutter(World world, double exposure_s, double readout_s) {
  camera_of(world).exposure_s = exposure_s;
  camera_of(world).readout_s = readout_s;
  return world;
}

// A flight whose attitude was noted at every step.
struct Flight {
  std::unique_ptr<Simulator> simulator;
  std::vector<uav::BodyState> truth;

  explicit Flight(World world) : simulator(make_simulator(std::move(world))) { note(); }

  void advance(Duration d) {
    const SimTime end = simulator->now() + d;
    while (simulator->now() < end) {
      simulator->advance_to(simulator->now() + 1ms);
      note();
    }
  }
  uav::CameraSample image() { return measure_now<uav::CameraSample>(*simulator, kCamera); }

  uav::Pose X_WB(double ago_s) const {
    const uav::BodyState& b =
        truth[truth.size() - 1 - static_cast<std::size_t>(std::lround(1000.0 * ago_s))];
    return {b.p_WB, b.q_WB};
  }

 private:
  void note() { truth.push_back(simulator->ground_truth(0).body); }
};

// Turning to the left at about 1 rad/s, the edge near the middle.
Flight turning(World world) {
  world.uavs[0].X_WB.q = uav::from_rpy(0.0, 0.0, -0.8);
  Flight flight(std::move(world));
  flight.simulator->apply(0, uav::to_setpoint({{}, 1.0}));
  flight.advance(1s);
  return flight;
}

double light(std::uint8_t byte) {
  const double c = byte / 255.0;
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

// Where a line of light from dark to bright has its edge, and the square of how wide the edge is
// beyond the distance of two pixels: from mean and variance of the steps between neighbours.
struct Edge {
  double at_px = 0.0;
  double width_px2 = 0.0;
};
Edge measure_edge(const std::vector<double>& line) {
  double sum = 0.0;
  double first = 0.0;
  double second = 0.0;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const double step = line[i + 1] - line[i];
    const double at = static_cast<double>(i) + 0.5;
    sum += step;
    first += step * at;
    second += step * at * at;
  }
  const double mean = first / sum;
  return {mean, 12.0 * (second / sum - mean * mean) - 1.0};
}

std::size_t byte_of(int column, int row) {
  return 3 * static_cast<std::size_t>(row * kWidth + column);
}

Edge edge_of_row(const uav::CameraSample& image, int row) {
  std::vector<double> line;
  for (int column = 0; column < kWidth; ++column) {
    line.push_back(light(image.rgb[byte_of(column, row)]));
  }
  return measure_edge(line);
}

// Where the edge is to be seen in a row by a UAV posed so.
double expected_edge_px(const World& world, const uav::Pose& X_WB, int row) {
  const Sensor& sensor = world.uavs[0].sensors[kCamera];
  const uav::CameraModel& camera = std::get<CameraModel>(sensor.model).intrinsics;
  const uav::Pose X_CW = inverse(X_WB * sensor.X_BS * uav::Pose{{}, uav::q_body_from_optical()});
  double low_z = -20.0;
  double high_z = 20.0;
  uav::Pixel pixel;
  for (int i = 0; i < 60; ++i) {
    const double z = 0.5 * (low_z + high_z);
    pixel = *camera.project(transform(X_CW, {kWall_m, 0.0, z}));
    (pixel.v_px > row ? low_z : high_z) = z;
  }
  return pixel.u_px;
}

constexpr int kBand = 40;

// Over a band of rows: how the edge lies to where it would be with all rows exposed for an instant
// at the image's time, where the shutter's formula has it, and the same of its width.
struct Band {
  double offset_px = 0.0;
  double expected_offset_px = 0.0;
  double width_px = 0.0;
  double expected_width_px = 0.0;
};
Band measure_band(const Flight& flight, const uav::CameraSample& image, int first_row) {
  const World& world = flight.simulator->world();
  const auto& camera = std::get<CameraModel>(world.uavs[0].sensors[kCamera].model);
  Band band;
  for (int row = first_row; row < first_row + kBand; ++row) {
    const double end_s = camera.readout_s * (kHeight - 1 - row) / (kHeight - 1);
    const double now_px = expected_edge_px(world, flight.X_WB(0.0), row);
    const double end_px = expected_edge_px(world, flight.X_WB(end_s), row);
    const double begin_px = expected_edge_px(world, flight.X_WB(end_s + camera.exposure_s), row);
    const Edge edge = edge_of_row(image, row);
    band.offset_px += (edge.at_px - now_px) / kBand;
    band.expected_offset_px += (0.5 * (begin_px + end_px) - now_px) / kBand;
    band.width_px += edge.width_px2 / kBand;
    band.expected_width_px += (end_px - begin_px) / kBand;
  }
  band.width_px = std::sqrt(std::max(0.0, band.width_px));
  return band;
}

void expect_edges_of_the_shutter(World world) {
  Flight flight = turning(std::move(world));
  const uav::CameraSample image = flight.image();
  for (int row = 0; row < kHeight; row += kBand) {
    const Band band = measure_band(flight, image, row);
    EXPECT_NEAR(band.offset_px, band.expected_offset_px, 0.15) << row;
    EXPECT_NEAR(band.width_px, band.expected_width_px, 0.25 + 0.05 * band.expected_width_px) << row;
  }
}

TEST(CamerasTest, ExposureBlursByRateTimesFocalLength) {
  const double focal_px = testing::camera_intrinsics(kWidth, kHeight).fx_px;
  for (const double exposure_s : {0.0, 0.01, 0.06}) {
    SCOPED_TRACE(exposure_s);
    Flight flight = turning(with_shutter(edge_world(), exposure_s, 0.0));
    const double blur_px = flight.truth.back().w_WB_B.z * focal_px * exposure_s;
    EXPECT_NEAR(measure_band(flight, flight.image(), 100).width_px, blur_px, 0.25 + 0.1 * blur_px);
  }
}

// How many grey levels of a picture are neither of the background nor of the wall.
std::size_t mixed_bytes(const uav::CameraSample& image) {
  return static_cast<std::size_t>(
      std::ranges::count_if(image.rgb, [](std::uint8_t byte) { return byte != 0 && byte != 255; }));
}

// Nothing moves, so that only the coverage of pixels gives values between black and white.
TEST(CamerasTest, AntialiasingMixesTheColoursAtAnEdge) {
  World world = edge_world();
  const uav::CameraSample plain = Flight(world).image();
  EXPECT_EQ(mixed_bytes(plain), 0U);
  EXPECT_GT(std::ranges::count(plain.rgb, 0), 0);
  EXPECT_GT(std::ranges::count(plain.rgb, 255), 0);
  camera_of(world).antialias = true;
  const uav::CameraSample smooth = Flight(world).image();
  EXPECT_GT(mixed_bytes(smooth), std::size_t{3} * kHeight / 2) << "one pixel in most rows";
  EXPECT_LT(mixed_bytes(smooth), std::size_t{3} * kHeight * 3) << "only at the edge";
}

TEST(CamerasTest, RollingShutterLeansAnUprightEdge) {
  expect_edges_of_the_shutter(with_shutter(edge_world(), 0.0, 0.03));
}

TEST(CamerasTest, ExposureAndReadoutTogether) {
  expect_edges_of_the_shutter(with_shutter(edge_world(), 0.02, 0.03));
  expect_edges_of_the_shutter(with_shutter(edge_world(), 0.05, 0.01));
}

// Rows are those of the image that comes out, not of the ideal one that it is made of.
TEST(CamerasTest, RowsOfADistortedImageHaveTheirOwnTimes) {
  World world = with_shutter(edge_world(), 0.02, 0.03);
  uav::CameraModel& camera = camera_of(world).intrinsics;
  camera.k1 = -0.25;
  camera.k2 = 0.05;
  camera.p1 = 0.01;
  camera.p2 = -0.005;
  camera.fy_px *= 1.1;
  expect_edges_of_the_shutter(world);
}

// Ideal views by the embedded simulator's renderer, as an external simulator would draw them.
class IdealViews final : public ViewRenderer {
 public:
  explicit IdealViews(const std::shared_ptr<const raster::Scene>& scene) : renderer_(scene) {}

  void render(const View& view, std::span<std::uint8_t> rgb) override {
    const raster::Instant instant{view.X_WS * uav::Pose{{}, uav::q_body_from_optical()}, view.X_WB};
    raster::View drawn;
    drawn.camera = view.camera;
    drawn.near_m = view.near_m;
    drawn.far_m = view.far_m;
    drawn.instants = {&instant, 1};
    drawn.hidden = view.hidden;
    raster::Picture picture;
    picture.rgb = rgb;
    depth_m_.resize(rgb.size() / 3);
    picture.depth_m = depth_m_;
    renderer_.draw(drawn, picture);
  }
  double nearest_depth_m() override { return *std::min_element(depth_m_.begin(), depth_m_.end()); }
  std::string name() const override { return "ideal"; }

 private:
  Renderer renderer_;
  std::vector<float> depth_m_;
};

// A flight down the corridor with a turn, at each millisecond.
struct Approach {
  static constexpr int kSteps = 30;

  Approach() {
    for (int i = 0; i <= kSteps; ++i) {
      const double t_s = 0.001 * (i - kSteps);
      bodies.push_back(
          {{1.2 + 0.8 * t_s, 0.2 * t_s, 1.2}, uav::from_rpy(0.0, 0.3 * t_s, 0.5 * t_s)});
    }
    for (const uav::Pose& X_WB : bodies) {
      instants.push_back(
          {X_WB * uav::Pose{{0.1, 0.0, 0.0}, uav::q_body_from_optical()}, {&X_WB, 1}});
    }
  }
  std::vector<uav::Pose> bodies;
  std::vector<raster::Instant> instants;
};

// Of all bytes: how far apart they are on average, and how many are more than 24 grey levels apart.
struct Difference {
  double mean = 0.0;
  double share_of_unlike = 0.0;
};
Difference difference(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
  Difference d;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const int off = std::abs(a[i] - b[i]);
    d.mean += off / static_cast<double>(a.size());
    d.share_of_unlike += (off > 24 ? 1.0 : 0.0) / static_cast<double>(a.size());
  }
  return d;
}

// What external simulators' pictures are composed to is what the embedded simulator draws.
TEST(CamerasTest, DrawnAndComposedPicturesAreAlike) {
  const std::filesystem::path root = TETHER_SOURCE_DIR;
  WorldRequest request;
  request.world = root / "data/worlds/corridor.sdf";
  request.uavs = {{"alpha", root / "data/models/hummingbird/model.sdf", {1.2, 0.0, 1.2}, 0.0}};
  const World world = load_world(request, testing::no_warnings());
  const auto scene =
      std::make_shared<const raster::Scene>(make_scene(world, testing::no_warnings()));
  Renderer drawing(scene);
  const auto composing =
      make_composite_renderer(std::make_unique<IdealViews>(scene), {scene->body_radii_m().at(0)});
  const Approach approach;
  for (int kind = 0; kind < 8; ++kind) {
    raster::View view;
    view.camera = testing::camera_intrinsics(kWidth, kHeight);
    if (kind & 1) view.camera.k1 = -0.25, view.camera.k2 = 0.05, view.camera.p1 = 0.004;
    view.exposure_s = kind & 2 ? 0.01 : 0.0;
    view.readout_s = kind & 4 ? 0.02 : 0.0;
    view.instants = approach.instants;
    view.spacing_s = 0.001;
    view.hidden = 0;
    std::vector<std::uint8_t> drawn(byte_of(0, kHeight));
    std::vector<std::uint8_t> composed(drawn.size());
    raster::Picture picture;
    picture.rgb = drawn;
    drawing.draw(view, picture);
    picture.rgb = composed;
    composing->draw(view, picture);
    const Difference d = difference(drawn, composed);
    const bool is_resampled = (kind & 1) != 0;  // which makes edges and textures softer
    EXPECT_LT(d.mean, is_resampled ? 2.5 : 1.5) << kind;
    EXPECT_LT(d.share_of_unlike, is_resampled ? 0.03 : 0.015) << kind;
    if (kind < 2) continue;
    view.instants = view.instants.last(1);
    drawing.draw(view, picture);
    EXPECT_GT(difference(drawn, composed).mean, 2.0 * d.mean) << kind << ": without the shutter";
  }
}

}  // namespace
}  // namespace tether::sim
