#include <gtest/gtest.h>

#include <tether/sim/bodies.h>
#include <tether/sim_testing/fake_simulator.h>

namespace tether::sim {
namespace {

Model model_of(const std::string& name, bool is_static, const uav::Vec3& p_WM) {
  Model model;
  model.name = name;
  model.is_static = is_static;
  model.X_WM.p = p_WM;
  model.links.resize(2);
  model.links[1].X_ML.p = {0.0, 0.0, 1.0};
  return model;
}

World mixed_world() {
  World world = make_fake_world(2);
  world.models = {model_of("wall", true, {5.0, 0.0, 0.0}), model_of("ball", false, {6.0, 0.0, 0.0}),
                  model_of("house", true, {7.0, 0.0, 0.0}),
                  model_of("cart", false, {8.0, 0.0, 0.0})};
  return world;
}

TEST(BodiesTest, UavsAndLinksOfDynamicModelsMoveAndThoseOfStaticModelsDoNot) {
  const World world = mixed_world();
  const std::vector<MovingBody> moving = moving_bodies(world);
  const std::vector<FixedBody> fixed = fixed_bodies(world);
  ASSERT_EQ(moving.size(), 6U);
  ASSERT_EQ(fixed.size(), 4U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(moving[i].uav, &world.uavs[i]);
    EXPECT_EQ(moving[i].model, nullptr);
    EXPECT_EQ(moving[i].link, &world.uavs[i].body);
    EXPECT_EQ(moving[i].X_WB, world.uavs[i].X_WB);
  }
  for (std::size_t i = 0; i < 4; ++i) {
    const Model& dynamic = world.models[i < 2 ? 1 : 3];
    EXPECT_EQ(moving[i + 2].uav, nullptr);
    EXPECT_EQ(moving[i + 2].model, &dynamic);
    EXPECT_EQ(moving[i + 2].link, &dynamic.links[i % 2]);
    EXPECT_EQ(moving[i + 2].X_WB, dynamic.X_WM * dynamic.links[i % 2].X_ML);
    const Model& still = world.models[i < 2 ? 0 : 2];
    EXPECT_EQ(fixed[i].link, &still.links[i % 2]);
    EXPECT_EQ(fixed[i].X_WB, still.X_WM * still.links[i % 2].X_ML);
  }
}

TEST(BodiesTest, ADrivenModelStartsWhereItsPathBegins) {
  World world = mixed_world();
  world.models[1].path =
      DrivenPath{{{{Duration{0}, {0.0, 2.0, 0.0}, 0.0}}}, world.models[1].X_WM.p};
  EXPECT_EQ(moving_bodies(world)[3].X_WB.p, (uav::Vec3{6.0, 2.0, 1.0}));
}

}  // namespace
}  // namespace tether::sim
