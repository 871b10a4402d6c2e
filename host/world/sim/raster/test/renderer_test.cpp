#include "test_scenes.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <thread>
#include <utility>

#include <gmock/gmock.h>
#include <hwy/targets.h>

#include <tether/base/error.h>
#include <tether/base_testing/golden.h>
#include <tether/base_testing/sanitizer.h>
#include <tether/sim_raster/renderer.h>

namespace tether::raster {
namespace {

// The views of the determinism tests: plain, exposed, rolling, distorted, antialiased.
std::vector<std::uint64_t> hashes(Renderer& renderer) {
  const std::vector<uav::Pose> bodies(1);
  std::vector<Instant> instants;
  for (int i = 0; i < 4; ++i) {
    instants.push_back(
        {{{0.02 * i, 0.01 * i, 0.03 * i}, uav::from_axis_angle({0.0, 1.0, 0.0}, 0.01 * i)},
         bodies});
  }
  std::vector<std::uint64_t> result;
  for (int kind = 0; kind < 5; ++kind) {
    View view;
    view.camera = kind == 3 ? bent_camera() : small_camera(157, 119);
    view.instants = instants;
    if (kind == 0) view.instants = view.instants.first(1);
    if (kind == 1 || kind == 3) view.exposure_s = 0.01;
    if (kind == 2 || kind == 3) view.readout_s = 0.02;
    view.spacing_s = (view.exposure_s + view.readout_s) / 3.0;
    view.antialias = kind == 4;
    result.push_back(hash_of(draw(renderer, view)));
  }
  return result;
}

// Draws with one set of instructions for as long as it lives.
class ForcedInstructions {
 public:
  explicit ForcedInstructions(std::int64_t target) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().DeInit();
  }
  ~ForcedInstructions() {
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().DeInit();
  }
  ForcedInstructions(const ForcedInstructions&) = delete;
  ForcedInstructions& operator=(const ForcedInstructions&) = delete;
};

// The golden bytes are the same on every machine; they change with the arithmetic only.
// Starts its threads for each picture.
class TwoHelpers final : public Helpers {
 public:
  int threads() const override { return 2; }
  void share(int count, const Part& draw) override {
    std::atomic<int> next = 0;
    const auto work = [&] {
      for (int part = next++; part < count; part = next++) draw(part);
    };
    const std::jthread first(work);
    const std::jthread second(work);
    work();
  }
};

TEST(Renderer, GivesTheGoldenBytesWithAllInstructionsAndThreads) {
  const Scene scene(rich_parts());
  Renderer one(scene);
  const std::vector<std::uint64_t> expected = hashes(one);
  ASSERT_EQ(expected.size(), 5U);
  expect_golden(std::filesystem::path(TETHER_TEST_DIR) / "data/golden.txt",
                {{"plain", expected[0]},
                 {"exposed", expected[1]},
                 {"rolling", expected[2]},
                 {"distorted", expected[3]},
                 {"antialiased", expected[4]}});
  // With sanitizers there is one.
  const std::vector<std::int64_t> targets = hwy::SupportedAndGeneratedTargets();
  for (std::size_t i = 0; targets.size() > 1 && i < targets.size(); ++i) {
    const ForcedInstructions forced(targets[i]);
    Renderer renderer(scene);
    EXPECT_EQ(hashes(renderer), expected) << Renderer::instructions();
  }
  TwoHelpers helpers;
  Renderer three(scene, &helpers);
  for (const char* const when : {"first", "after other pictures"}) {
    EXPECT_EQ(hashes(three), expected) << "with three threads, " << when;
  }
}

TEST(Renderer, RefusesAProcessorWithoutTheInstructionsItNeeds) {
  const Scene scene(rich_parts());
  const ForcedInstructions none(HWY_SCALAR);
  try {
    const Renderer renderer(scene);
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ErrorCode::kSetup);
  }
}

// A textured wall that is all that most tiles show, and a ball before it.
SceneParts wall_parts() {
  SceneParts parts = plain_parts(rectangle(-9.0F, -9.0F, 9.0F, 9.0F, 3.0F), {1.0F, 1.0F, 1.0F});
  parts.textures.push_back(noise(5, 64, 64));
  parts.materials[0].texture = 0;
  parts.meshes.push_back(ball(0.2F, 8));
  Instance before = parts.instances[0];
  before.mesh = 1;
  before.body = 0;
  before.X_BV.p = {0.5, 0.2, 2.0};
  parts.instances.push_back(before);
  return parts;
}

void expect_the_same_without_depths(Renderer& renderer, const View& view, const Drawing& all) {
  Drawing some = all;
  std::ranges::fill(some.rgb, std::uint8_t{1});
  std::ranges::fill(some.entity, 77U);
  Picture picture;
  picture.rgb = some.rgb;
  picture.entity = some.entity;
  renderer.draw(view, picture);
  EXPECT_EQ(hash_of(some), hash_of(all));
}

// Whatever moves, however fast, seen through whatever lens and shutter.
TEST(Renderer, DrawsAnyViewTheSameWithAllInstructionsAndThreads) {
  SceneParts opaque = rich_parts();
  opaque.materials[2].alpha = 1.0F;
  const std::array scenes{Scene(rich_parts()), Scene(opaque), Scene(wall_parts())};
  const std::vector<std::int64_t> targets = hwy::SupportedAndGeneratedTargets();
  TwoHelpers helpers;
  for (std::uint64_t seed = 0; seed < 24; ++seed) {
    const auto some = [&](std::uint64_t i) { return drawn(seed, i, -1.0, 1.0); };
    const double fast = std::pow(10.0, drawn(seed, 20, -4.0, -0.5));
    std::vector<uav::Pose> bodies(3);
    std::vector<Instant> instants;
    for (int i = 0; i < 3; ++i) {
      uav::Pose& body = bodies[static_cast<std::size_t>(i)];
      body.p = (fast * i) * uav::Vec3{some(0), some(1), some(2)};
      body.q = uav::from_axis_angle({0.0, 0.0, 1.0}, fast * i * some(3));
      instants.push_back({{(fast * i) * uav::Vec3{some(4), some(5), some(6)},
                           uav::from_axis_angle({0.6, 0.8, 0.0}, fast * i * some(7))},
                          {&body, 1}});
    }
    View view;
    view.camera = seed % 3 == 0 ? bent_camera(97, 71) : small_camera(97, 71);
    view.instants = instants;
    view.exposure_s = seed % 4 == 0 ? 0.0 : 0.01;
    view.readout_s = seed % 2 == 0 ? 0.02 : 0.0;
    view.spacing_s = 0.5 * (view.exposure_s + view.readout_s);
    view.antialias = seed % 5 == 0;
    if (seed % 7 == 0) view.far_m = 2.9;
    for (const Scene& scene : scenes) {
      Renderer alone(scene);
      const Drawing all = draw(alone, view);
      const std::uint64_t expected = hash_of(all);
      Renderer helped(scene, &helpers);
      EXPECT_EQ(hash_of(draw(helped, view)), expected) << seed << ": with helpers";
      expect_the_same_without_depths(helped, view, all);
      for (std::size_t i = 0; targets.size() > 1 && i < targets.size(); ++i) {
        const ForcedInstructions forced(targets[i]);
        EXPECT_EQ(hash_of(draw(alone, view)), expected) << seed << ": " << Renderer::instructions();
        expect_the_same_without_depths(alone, view, all);
      }
    }
  }
}

struct BadView {
  const char* what;
  std::function<void(View&)> spoil;
};

TEST(Renderer, RefusesViewsThatCannotBeDrawn) {
  constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
  const Scene scene(rich_parts());
  Renderer renderer(scene);
  const std::vector<uav::Pose> bodies(1);
  const Instant instant{{}, bodies};
  const std::vector<Instant> two(2, instant);
  const std::vector<BadView> bad{
      {"no width", [](View& v) { v.camera.width_px = 0; }},
      {"too high", [](View& v) { v.camera.height_px = 8193; }},
      {"no focal length", [](View& v) { v.camera.fx_px = 0.0; }},
      {"principal point", [=](View& v) { v.camera.cx_px = kNotANumber; }},
      {"distortion", [=](View& v) { v.camera.k1 = kNotANumber; }},
      {"near", [](View& v) { v.near_m = 0.0; }},
      {"far", [](View& v) { v.far_m = v.near_m; }},
      {"no instant", [](View& v) { v.instants = {}; }},
      {"exposure", [](View& v) { v.exposure_s = -1.0; }},
      {"readout", [=](View& v) { v.readout_s = kNotANumber; }},
      {"instants after the beginning",
       [&](View& v) { v.instants = two, v.spacing_s = 0.009, v.readout_s = 0.01; }},
  };
  for (const BadView& view : bad) {
    View spoilt;
    spoilt.camera = small_camera();
    spoilt.instants = {&instant, 1};
    view.spoil(spoilt);
    EXPECT_THROW(renderer.draw(spoilt, {}), Error) << view.what;
  }
  View view;
  view.camera = small_camera();
  const Instant without_body;
  view.instants = {&without_body, 1};
  EXPECT_THROW(renderer.draw(view, {}), Error);
  Instant nowhere = instant;
  nowhere.X_WC.p.x = kNotANumber;
  view.instants = {&nowhere, 1};
  EXPECT_THROW(renderer.draw(view, {}), Error);
  view.instants = {&instant, 1};
  std::vector<std::uint8_t> too_small(10);
  Picture picture;
  picture.rgb = too_small;
  EXPECT_THROW(renderer.draw(view, picture), Error);
}

TEST(Renderer, DrawsFromWithinThings) {
  SceneParts parts = rich_parts();
  parts.meshes.push_back(ball(0.03F, 8));
  parts.meshes.push_back(box(0.2F));
  Instance around;
  around.mesh = 3;
  parts.instances.push_back(around);
  around.mesh = 4;
  parts.instances.push_back(around);
  draw(Scene(parts), small_camera());
}

// With sanitizers, a picture of the largest size takes 20 s.
TEST(Renderer, DrawsPicturesOfTheLargestSize) {
  constexpr bool kIsSanitized = TETHER_ADDRESS_SANITIZER || TETHER_THREAD_SANITIZER;
  constexpr int kOther_px = kIsSanitized ? 40 : kMaxImageSize_px;
  const Scene scene(plain_parts(rectangle(-0.25F, -0.25F, 0.25F, 0.25F, 2.0F), {1, 1, 1}));
  for (const auto& [width_px, height_px] :
       {std::pair{kMaxImageSize_px, kOther_px}, std::pair{kOther_px, kMaxImageSize_px}}) {
    const uav::CameraModel camera = small_camera(width_px, height_px);
    const Drawing drawing = draw(scene, camera);
    const PixelBox box = visible_boxes(drawing.entity, camera.width_px).at(7);
    const double size_px = 0.25 * camera.fx_px;
    EXPECT_NEAR(box.right - box.left + 1, std::min(size_px, 1.0 * width_px), 1.0);
    EXPECT_NEAR(box.bottom - box.top + 1, std::min(size_px, 1.0 * height_px), 1.0);
    EXPECT_NEAR(box.left + box.right, width_px - 1, 1.0);
    EXPECT_NEAR(box.top + box.bottom, height_px - 1, 1.0);
    if (!kIsSanitized) break;
  }
}

TEST(Renderer, HidesABody) {
  const Scene scene(rich_parts());
  Renderer renderer(scene);
  const std::vector<uav::Pose> bodies(1);
  const Instant instant{{}, bodies};
  View view;
  view.camera = small_camera();
  view.instants = {&instant, 1};
  EXPECT_TRUE(visible_boxes(draw(renderer, view).entity, 160).contains(5));
  view.hidden = 0;
  EXPECT_FALSE(visible_boxes(draw(renderer, view).entity, 160).contains(5));
}

TEST(Renderer, GivesDepthAsTheRobotsStandardHasIt) {
  SceneParts parts = plain_parts(rectangle(-9, -9, 0, 9, 2), {1, 1, 1});
  parts.meshes.push_back(rectangle(0, -9, 9, 0, 20));
  Instance far = parts.instances[0];
  far.mesh = 1;
  parts.instances.push_back(far);
  const Scene scene(parts);
  Renderer renderer(scene);
  const Instant instant;
  View view;
  view.camera = small_camera(40, 40);
  view.instants = {&instant, 1};
  std::vector<float> depth(1600);
  Picture picture;
  picture.depth_m = depth;
  picture.depth_max_m = 10.0F;
  renderer.draw(view, picture);
  EXPECT_FLOAT_EQ(depth[20 * 40 + 5], 2.0F);
  EXPECT_EQ(depth[12 * 40 + 30], std::numeric_limits<float>::infinity());
  EXPECT_EQ(depth[35 * 40 + 30], std::numeric_limits<float>::infinity());
  picture.depth_min_m = 3.0F;
  picture.depth_max_m = 50.0F;
  renderer.draw(view, picture);
  EXPECT_EQ(depth[20 * 40 + 5], -std::numeric_limits<float>::infinity());
  EXPECT_NEAR(depth[12 * 40 + 30], 20.0F, 1e-4);
}

TEST(VisibleBoxes, AreThoseOfWhatIsSeen) {
  const std::vector<std::uint32_t> entity{0, 3, 3, 0,  //
                                          0, 0, 3, 9,  //
                                          3, 0, 0, 9};
  const auto boxes = visible_boxes(entity, 4);
  ASSERT_EQ(boxes.size(), 2U);
  EXPECT_EQ(boxes.at(3), (PixelBox{0, 0, 2, 2, 4}));
  EXPECT_EQ(boxes.at(9), (PixelBox{3, 1, 3, 2, 2}));
}

}  // namespace
}  // namespace tether::raster
