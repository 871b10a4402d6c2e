#include "sdf16_shapes.h"

#include <cmath>
#include <numbers>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/sim_testing/test_worlds.h>

namespace tether::sim {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::test_uav;

class Sdf16Shapes : public ::testing::Test {
 protected:
  std::vector<Visual> visuals() { return sdf16_visuals(uav_, note_); }
  std::vector<Collision> collisions() { return sdf16_collisions(uav_, note_); }

  Uav uav_ = test_uav("alpha", {});
  std::vector<std::string> warnings_;
  WarningSink note_ = [this](const Warning& warning) { warnings_.push_back(to_line(warning)); };
};

TEST_F(Sdf16Shapes, KeepsThoseThatSdf16Has) {
  ASSERT_EQ(visuals().size(), 1u);
  EXPECT_EQ(visuals()[0].name, "box");
  EXPECT_EQ(std::get<BoxGeometry>(visuals()[0].geometry).size_m, (uav::Vec3{0.4, 0.4, 0.1}));
  EXPECT_EQ(collisions().size(), 1u);
  EXPECT_THAT(warnings_, ElementsAre());
}

TEST_F(Sdf16Shapes, SplitsACapsuleIntoThree) {
  // Its axis along x.
  uav_.body.collisions[0].X_LC = {{1.0, 2.0, 3.0}, uav::from_rpy(0.0, std::numbers::pi / 2.0, 0.0)};
  uav_.body.collisions[0].geometry = CapsuleGeometry{0.25, 2.0};
  const auto parts = collisions();
  ASSERT_EQ(parts.size(), 3u);
  EXPECT_EQ(std::get<CylinderGeometry>(parts[0].geometry).length_m, 2.0);
  EXPECT_EQ(std::get<SphereGeometry>(parts[1].geometry).radius_m, 0.25);
  EXPECT_NEAR(parts[1].X_LC.p.x, 2.0, 1e-12);
  EXPECT_NEAR(parts[2].X_LC.p.x, 0.0, 1e-12);
  EXPECT_NEAR(parts[2].X_LC.p.z, 3.0, 1e-12);
  EXPECT_EQ((std::set{parts[0].name, parts[1].name, parts[2].name}).size(), 3u);
  EXPECT_THAT(warnings_, ElementsAre());
}

TEST_F(Sdf16Shapes, TurnsAnEllipsoidIntoASphereWithAWarning) {
  uav_.body.visuals[0].geometry = EllipsoidGeometry{{2.0, 2.0, 2.0}};
  visuals();
  EXPECT_THAT(warnings_, ElementsAre()) << "a ball";
  uav_.body.visuals[0].geometry = EllipsoidGeometry{{1.0, 2.0, 4.0}};
  EXPECT_DOUBLE_EQ(std::get<SphereGeometry>(visuals().at(0).geometry).radius_m, 2.0);
  EXPECT_THAT(warnings_, ElementsAre(AllOf(HasSubstr("'alpha'"), HasSubstr("'box'"))));
}

TEST_F(Sdf16Shapes, GivesUniqueNamesWithoutColons) {
  for (const char* name : {"arm::box", "leg::box"}) {
    uav_.body.visuals.push_back(uav_.body.visuals[0]);
    uav_.body.visuals.back().name = name;
  }
  std::set<std::string> names;
  for (const Visual& visual : visuals()) {
    EXPECT_TRUE(names.insert(visual.name).second) << visual.name;
    EXPECT_EQ(visual.name.find(':'), std::string::npos);
  }
}

}  // namespace
}  // namespace tether::sim
