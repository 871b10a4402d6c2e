#include "open_request.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/base_testing/thrown_error.h>
#include <tether/sim_testing/test_worlds.h>

namespace tether::sim {
namespace {

using testing::box_model;

/// Of a body that shows one such shape in its origin.
double radius_of(const Geometry& geometry) {
  World world;
  Model model = box_model("m", {}, {1.0, 1.0, 1.0}, {}, false);
  model.links[0].visuals[0].geometry = geometry;
  world.models.push_back(model);
  return drawn_radii_m(world).at(0);
}

TEST(DrawnRadii, ReachToTheFarthestPoint) {
  EXPECT_DOUBLE_EQ(radius_of(BoxGeometry{{2.0, 4.0, 4.0}}), 3.0);
  EXPECT_DOUBLE_EQ(radius_of(CylinderGeometry{3.0, 8.0}), 5.0);
  EXPECT_DOUBLE_EQ(radius_of(SphereGeometry{0.5}), 0.5);
  EXPECT_DOUBLE_EQ(radius_of(CapsuleGeometry{0.5, 2.0}), 1.5);
  EXPECT_DOUBLE_EQ(radius_of(EllipsoidGeometry{{1.0, 3.0, 2.0}}), 3.0);
  EXPECT_DOUBLE_EQ(radius_of(PlaneGeometry{{0.0, 0.0, 1.0}, 6.0, 8.0}), 5.0);
}

TEST(DrawnRadii, CountFromTheBodysOrigin) {
  World world;
  Model model = box_model("m", {9.0, 9.0, 9.0}, {2.0, 4.0, 4.0}, {}, false);
  model.links[0].visuals[0].X_LV.p = {0.0, 3.0, 4.0};
  world.models = {box_model("wall", {}, {50.0, 50.0, 50.0}, {}), model};
  EXPECT_THAT(drawn_radii_m(world), ::testing::ElementsAre(8.0));
}

TEST(DrawnRadii, OfMeshesNeedAReadableFile) {
  const ScratchFolder folder;
  const auto mesh = folder.write("m.obj", "v 0 0 0\nv 3 0 0\nv 0 4 0\nf 1 2 3\n");
  EXPECT_NEAR(radius_of(MeshGeometry{mesh, "", {2.0, 1.0, 1.0}}), 6.0, 1e-6);
  const auto bad = folder.write("bad.obj", "no mesh");
  EXPECT_EQ(bad_file_error([&] {
              radius_of(MeshGeometry{bad, "", {1.0, 1.0, 1.0}});
            })
                .where()
                .file,
            bad.string());
}

}  // namespace
}  // namespace tether::sim
