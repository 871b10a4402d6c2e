#include "exposure.h"

#include "shade/light_table.h"
#include "strip_renderer.h"
#include "test_scenes.h"

#include <cmath>
#include <optional>

#include <gtest/gtest.h>

namespace tether::raster {
namespace {

using uav::Pose;
using uav::Vec3;

// A camera that turns to the right and moves ahead, in a rich scene.
struct Flight {
  explicit Flight(double speed) {
    bodies.resize(2);
    bodies[1].p = {0.05 * speed, 0.0, 0.0};
    for (int i = 0; i <= 10; ++i) {
      const double s = 0.1 * i;
      poses.push_back({{0.02 * speed * s, 0.0, 0.1 * speed * s},
                       uav::from_axis_angle({0.0, 1.0, 0.0}, 0.03 * speed * s)});
    }
    for (const uav::Pose& pose : poses) instants.push_back({pose, {bodies.data(), 1}});
    view.camera = small_camera();
    view.instants = instants;
    view.spacing_s = 0.003;
  }

  std::vector<uav::Pose> bodies;
  std::vector<uav::Pose> poses;
  std::vector<Instant> instants;
  View view;
};

View plain_view(const Flight& flight, double before_end_s, Moment& moment, Instant& instant) {
  interpolate(flight.view, before_end_s, moment);
  instant = {moment.X_WC, moment.X_WB};
  View view = flight.view;
  view.instants = {&instant, 1};
  return view;
}

Sampling sampling_of(const Scene& scene, const View& view) {
  const Lens lens(view.camera);
  const int width = view.camera.width_px;
  const int height = view.camera.height_px;
  Moment moment;
  Layer middle;
  place_layer(scene.prepared(), lens, {}, view, {0, height}, {0, 0, width - 1, height - 1},
              0.5 * (view.exposure_s + view.readout_s), moment, middle);
  return {view, lens, scene.body_radii_m(), middle};
}

Tile tile_at(int column, int row) {
  return {column / kTile_px * kTile_px, row, 1, 1};
}

TEST(Exposure, OfAStillSceneIsThePlainPicture) {
  const Scene scene(rich_parts());
  Renderer renderer(scene);
  Flight flight(0.0);
  flight.view.exposure_s = 0.01;
  flight.view.readout_s = 0.02;
  View plain = flight.view;
  plain.instants = plain.instants.first(1);
  EXPECT_EQ(draw(renderer, flight.view).rgb, draw(renderer, plain).rgb);
}

// Where an edge is seen by a camera that flies and turns while the edge moves, from geometry alone:
// everything right of x = −0.5 m on a plate 3 m ahead is white.
class MovingEdge {
 public:
  static constexpr double kEdge_m = -0.5;
  static constexpr double kDepth_m = 3.0;

  static Pose camera(double t_s) {
    return {{0.8 * t_s, -0.5 * t_s, 1.5 * t_s}, uav::from_axis_angle({0.0, 0.96, 0.28}, 1.6 * t_s)};
  }
  static Pose plate(double t_s) {
    return {{1.1 * t_s, 0.0, 0.0}, uav::from_axis_angle({0.0, 0.0, 1.0}, 0.3 - 0.9 * t_s)};
  }

  // A share of the light of a row's exposure: how long the ray of a pixel sees white.
  static double light(const View& view, double row, const Vec3& ray_C) {
    const int rows = view.camera.height_px;
    const double end_s = -view.readout_s * (rows - 1 - row) / (rows - 1);
    const int times = view.exposure_s > 0.0 ? 100 : 1;
    int white = 0;
    for (int i = 0; i < times; ++i) {
      if (sees_white(end_s - view.exposure_s * (i + 0.5) / times, ray_C)) ++white;
    }
    return 1.0 * white / times;
  }

 private:
  static bool sees_white(double t_s, const Vec3& ray_C) {
    const Pose X_BC = inverse(plate(t_s)) * camera(t_s);
    const Vec3 ray_B = rotate(X_BC.q, ray_C);
    return X_BC.p.x + ray_B.x * (kDepth_m - X_BC.p.z) / ray_B.z > kEdge_m;
  }
};

// The sample of a pixel is exact up to 1/512 px; a band of rows is drawn at the time of its middle,
// a quarter of a pixel's motion off at most; layers of an exposure are at most a pixel apart.
TEST(Exposure, ShowsEachPixelWhatItsRayMeetsInTheTimeOfItsRow) {
  SceneParts parts = plain_parts(
      rectangle(static_cast<float>(MovingEdge::kEdge_m), -9, 9, 9, MovingEdge::kDepth_m),
      {1, 1, 1});
  parts.instances[0].body = 0;
  const Scene scene(parts);
  Renderer renderer(scene);
  std::vector<Pose> bodies;
  for (int i = 0; i <= 30; ++i) bodies.push_back(MovingEdge::plate(0.001 * (i - 30)));
  std::vector<Instant> instants;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    instants.push_back(
        {MovingEdge::camera(0.001 * (static_cast<double>(i) - 30)), {&bodies[i], 1}});
  }
  int edges = 0;
  for (int kind = 0; kind < 8; ++kind) {
    View view;
    view.camera = kind % 2 == 1 ? bent_camera() : small_camera();
    view.instants = instants;
    view.spacing_s = 0.001;
    view.exposure_s = kind & 2 ? 0.01 : 0.0;
    view.readout_s = kind & 4 ? 0.02 : 0.0;
    const Sampling sampling =
        view.exposure_s + view.readout_s > 0.0 ? sampling_of(scene, view) : Sampling();
    EXPECT_TRUE(view.exposure_s == 0.0 || sampling.most_layers() > 2) << sampling.most_layers();
    EXPECT_TRUE(view.readout_s == 0.0 || sampling.band_rows() <= 16) << sampling.band_rows();
    const double off_px = view.readout_s > 0.0 ? 0.26 : 0.01;
    const Drawing drawing = draw(renderer, view);
    for (int row = 1; row < view.camera.height_px; row += 9) {
      double before = 0.0;
      for (int column = 0; column < view.camera.width_px; ++column) {
        const auto expected = [&](double aside_px) {
          return MovingEdge::light(view, row,
                                   view.camera.unproject({column + aside_px, 1.0 * row}));
        };
        const double light =
            light_table().light[static_cast<std::size_t>(drawing.at(column, row)[0])] / 65535.0;
        const int layers = sampling.layers(tile_at(column, row));
        const double off_light = layers > 1 ? 0.5 / layers + 0.02 : 0.0;
        const double left = expected(-off_px);
        const double right = expected(off_px);
        ASSERT_GE(light, left - off_light) << kind << ": " << column << ", " << row;
        ASSERT_LE(light, right + off_light) << kind << ": " << column << ", " << row;
        if (column > 0 && light > 0.5 && before <= 0.5) ++edges;
        before = light;
      }
    }
  }
  EXPECT_EQ(edges, 8 * 14) << "one in each row";
}

// An exposed picture is the mean light of pictures throughout the exposure.
TEST(Exposure, AveragesTheLightOfItsInstants) {
  const Scene scene(rich_parts());
  Renderer renderer(scene);
  for (const bool transparent : {true, false}) {
    SceneParts parts = rich_parts();
    if (!transparent) parts.materials[2].alpha = 1.0F;
    const Scene exposed_scene(parts);
    Renderer exposing(exposed_scene);
    Flight flight(2.0);
    flight.view.camera = small_camera(80, 60);
    flight.view.exposure_s = 0.01;
    const Drawing exposed = draw(exposing, flight.view);
    constexpr int kPictures = 16;
    std::vector<double> light(exposed.rgb.size());
    for (int i = 0; i < kPictures; ++i) {
      Moment moment;
      Instant instant;
      const View view = plain_view(flight, 0.01 * (i + 0.5) / kPictures, moment, instant);
      const Drawing one = draw(exposing, view);
      for (std::size_t k = 0; k < light.size(); ++k) {
        light[k] += static_cast<double>(light_table().light[one.rgb[k]]) / kPictures;
      }
    }
    double difference = 0.0;
    for (std::size_t k = 0; k < light.size(); ++k) {
      const int wanted = light_table().byte[static_cast<std::size_t>(std::lround(light[k]))];
      difference += std::abs(wanted - static_cast<int>(exposed.rgb[k]));
    }
    EXPECT_LT(difference / static_cast<double>(light.size()), 2.0) << transparent;
  }
}

// A camera that moves before a wall at z = 2, in two instants.
struct Shift {
  Shift(const Vec3& p_m, double turn_rad, double exposure_s, double readout_s)
      : from{{{-p_m.x, -p_m.y, -p_m.z}, uav::from_axis_angle({0.0, 1.0, 0.0}, -turn_rad)}, {}},
        instants{from, {}} {
    view.camera = small_camera(640, 480);
    view.camera.fx_px = view.camera.fy_px = 400.0;
    view.instants = instants;
    view.exposure_s = exposure_s;
    view.readout_s = readout_s;
    view.spacing_s = exposure_s + readout_s;
  }

  Instant from;
  std::array<Instant, 2> instants;
  View view;
};

TEST(Exposure, DividesTimeByTheMotionInThePicture) {
  const Scene scene(plain_parts(rectangle(-99, -99, 99, 99, 2), {1, 1, 1}));
  struct Case {
    double shift_px;
    int layers;
  };
  for (const Case& c : std::vector<Case>{{0.0, 1},
                                         {0.001, 1},
                                         {0.003, 3},
                                         {2.9, 3},
                                         {3.1, 9},
                                         {8.9, 9},
                                         {9.1, 27},
                                         {900.0, 27}}) {
    const Shift shift({c.shift_px / 200.0, 0.0, 0.0}, 0.0, 0.01, 0.0);
    const Sampling sampling = sampling_of(scene, shift.view);
    EXPECT_NEAR(sampling.exposed_px(tile_at(320, 240)), c.shift_px, 1e-4 * c.shift_px);
    EXPECT_EQ(sampling.layers(tile_at(320, 240)), c.layers) << c.shift_px;
    EXPECT_EQ(sampling.band_rows(), 0);
  }
  for (const Case& c : std::vector<Case>{
           {0.0, 0}, {0.4, 0}, {1.2, 192}, {7.0, 32}, {8.0, 28}, {30.0, 8}, {999.0, 4}}) {
    const Shift shift({c.shift_px / 200.0, 0.0, 0.0}, 0.0, 0.0, 0.02);
    EXPECT_EQ(sampling_of(scene, shift.view).band_rows(), c.layers) << c.shift_px;
  }
}

// What is seen moves by no more than was expected of its tile.
TEST(Exposure, ExpectsNoLessMotionThanThereIs) {
  const Scene scene(plain_parts(crumpled_sheet(3, 9, 5.0F), {1, 1, 1}));
  Renderer renderer(scene);
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const auto some = [&](std::uint64_t i) { return drawn(seed, i, -0.05, 0.05); };
    Shift shift({some(0), some(1), some(2)}, 0.2 * some(3), 0.01, 0.0);
    uav::Quat& q = shift.instants[0].X_WC.q;
    if (seed % 3 == 0) q = {-q.w, -q.x, -q.y, -q.z};  // the same attitude
    View view = shift.view;
    if (seed % 2 == 1) view.camera = bent_camera(320, 240);
    const Sampling sampling = sampling_of(scene, view);
    View last = view;
    last.instants = last.instants.last(1);
    const Drawing drawing = draw(renderer, last);
    const Pose X_then_now = inverse(shift.from.X_WC) * shift.instants[1].X_WC;
    uav::CameraModel straight = view.camera;
    straight.k1 = straight.k2 = straight.k3 = straight.p1 = straight.p2 = 0.0;
    for (std::uint64_t i = 10; i < 200; ++i) {
      const int column = static_cast<int>(drawn(seed, i, 0, view.camera.width_px));
      const int row = static_cast<int>(drawn(seed, 1000 + i, 0, view.camera.height_px));
      const int pixel = row * view.camera.width_px + column;
      const float z = drawing.depth_m[static_cast<std::size_t>(pixel)];
      if (!std::isfinite(z)) continue;
      const Vec3 p = static_cast<double>(z) * view.camera.unproject({1.0 * column, 1.0 * row});
      const auto now = straight.project(p);
      const auto then = straight.project(transform(X_then_now, p));
      const double moved_px = std::hypot(now->u_px - then->u_px, now->v_px - then->v_px);
      // Motion is a little uneven in the picture.
      EXPECT_LE(moved_px, 1.1 * sampling.exposed_px(tile_at(column, row)) + 0.01) << seed;
    }
  }
}

TEST(Exposure, ExpectsLittleMotionWhereTheCameraFliesTo) {
  const Scene scene(plain_parts(rectangle(-99, -99, 99, 99, 2), {1, 1, 1}));
  const Shift shift({0.0, 0.0, 0.05}, 0.0, 0.01, 0.0);
  const Sampling sampling = sampling_of(scene, shift.view);
  EXPECT_LT(sampling.exposed_px(tile_at(320, 240)), 1.2);
  EXPECT_GT(sampling.exposed_px(tile_at(0, 240)), 7.5);
}

// A wall 2 m ahead stays where it is in the picture if a camera turns as much as it flies past.
// Farther things would move as it turns, but not as far as by both.
TEST(Exposure, ExpectsNoSumOfMotionsThatCancel) {
  const Scene scene(plain_parts(rectangle(-99, -99, 99, 99, 2), {1, 1, 1}));
  constexpr double kShift_m = 0.05;
  const auto expected_px = [&](double turn_rad) {
    const Shift shift({kShift_m, 0.0, 0.0}, turn_rad, 0.01, 0.0);
    return sampling_of(scene, shift.view).exposed_px(tile_at(320, 240));
  };
  const double alone_px = 400.0 * kShift_m / 2.0;
  EXPECT_NEAR(expected_px(0.5 * kShift_m), 2.0 * alone_px, 0.05 * alone_px);
  EXPECT_NEAR(expected_px(-0.5 * kShift_m), alone_px, 0.05 * alone_px);
}

TEST(Exposure, ExpectsInEachTileTheMotionOfItsOwnTime) {
  const Scene scene(plain_parts(rectangle(-99, -99, 99, 99, 2), {1, 1, 1}));
  View view = Shift({}, 0.0, 0.002, 0.02).view;
  std::vector<Instant> instants(23);  // at rest until the middle, then faster and faster
  for (std::size_t i = 11; i < instants.size(); ++i) {
    const auto steps = static_cast<double>(i - 10);
    instants[i].X_WC.p.x = 0.001 * steps * steps;
  }
  view.instants = instants;
  view.spacing_s = 0.001;
  const Sampling sampling = sampling_of(scene, view);
  EXPECT_EQ(sampling.exposed_px(tile_at(320, 20)), 0.0);
  EXPECT_EQ(sampling.layers(tile_at(320, 20)), 1);
  EXPECT_LT(sampling.exposed_px(tile_at(320, 300)), 0.5 * sampling.exposed_px(tile_at(320, 470)));
}

TEST(Exposure, ExpectsTheMotionOfABodyWhereItMayBe) {
  SceneParts parts = plain_parts(box(0.2F), {1, 1, 1});
  parts.instances[0].body = 0;
  const Scene scene(parts);
  const std::array<Pose, 2> bodies{Pose{{0.0, 0.0, 5.0}, {}}, Pose{{0.05, 0.0, 5.0}, {}}};
  const std::array instants{Instant{{}, {&bodies[0], 1}}, Instant{{}, {&bodies[1], 1}}};
  View view = Shift({}, 0.0, 0.01, 0.0).view;
  view.instants = instants;
  const Sampling sampling = sampling_of(scene, view);
  EXPECT_GT(sampling.exposed_px(tile_at(320, 240)), 4.0);
  EXPECT_EQ(sampling.exposed_px(tile_at(20, 240)), 0.0);
  EXPECT_EQ(sampling.exposed_px(tile_at(320, 20)), 0.0);
  view.hidden = 0;
  EXPECT_EQ(sampling_of(scene, view).most_layers(), 1);
}

// For any shutter: the layers of a row are the middles of equal parts of [e − exposure, e].
TEST(Exposure, OfEachRowIsItsPartOfTheWindow) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    View view;
    view.camera.height_px = static_cast<int>(drawn(seed, 0, 1, 900));
    view.exposure_s = seed % 5 == 0 ? 0.0 : drawn(seed, 1, 0.0, 0.05);
    view.readout_s = seed % 7 == 0 ? 0.0 : drawn(seed, 2, 0.0, 0.05);
    const int rows = view.camera.height_px;
    const int row = static_cast<int>(drawn(seed, 3, 0, rows));
    const int layers = static_cast<int>(drawn(seed, 4, 1, 28));
    const double late_s = rows == 1 ? 0.0 : view.readout_s * (rows - 1 - row) / (rows - 1);
    const double part_s = view.exposure_s / layers;
    for (int k = 0; k < layers; ++k) {
      const double begin_s = late_s + view.exposure_s - part_s * k;
      EXPECT_NEAR(before_end_s(view, row, k, layers), begin_s - 0.5 * part_s, 1e-12) << seed;
    }
    EXPECT_EQ(before_end_s(view, rows - 1, 0, 1), 0.5 * view.exposure_s) << "ends with the last";
  }
}

TEST(Antialiasing, GivesEdgesTheShareThatIsCovered) {
  // Edges at quarters of a pixel: columns 20.0, 20.25, … of a picture with focal length 64.
  for (int quarter = 0; quarter < 4; ++quarter) {
    const float left = static_cast<float>((20.0 + 0.25 * quarter - 0.5 - 31.5) / 64.0 * 2.0);
    const Scene scene(plain_parts(rectangle(left, -9, 9, 9, 2), {1, 1, 1}));
    Renderer renderer(scene);
    uav::CameraModel camera = small_camera(64, 64);
    camera.fx_px = camera.fy_px = 64.0;
    const Instant instant;
    View view;
    view.camera = camera;
    view.instants = {&instant, 1};
    view.antialias = true;
    const Drawing drawing = draw(renderer, view);
    EXPECT_EQ(drawing.at(19, 30)[0], 0);
    EXPECT_EQ(drawing.at(21, 30)[0], 255);
    const double share =
        light_table().light[static_cast<std::size_t>(drawing.at(20, 30)[0])] / 65535.0F;
    EXPECT_NEAR(share, 1.0 - 0.25 * quarter, 0.01);
  }
}

}  // namespace
}  // namespace tether::raster
