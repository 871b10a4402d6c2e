#include "outside_shapes.h"

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

std::vector<std::string> warnings;
void note(const std::string& line) {
  warnings.push_back(line);
}

class OutsideShapes : public ::testing::Test {
 protected:
  OutsideShapes() { warnings.clear(); }
};

TEST_F(OutsideShapes, LeaveWhatEverySimulatorKnows) {
  const Uav uav = test_uav("alpha", {});
  const auto visuals = outside_visuals(uav, note);
  ASSERT_EQ(visuals.size(), 1u);
  EXPECT_EQ(visuals[0].name, "box");
  EXPECT_EQ(std::get<BoxGeometry>(visuals[0].geometry).size_m, (uav::Vec3{0.4, 0.4, 0.1}));
  EXPECT_EQ(outside_collisions(uav, note).size(), 1u);
  EXPECT_THAT(warnings, ElementsAre());
}

TEST_F(OutsideShapes, MakeACapsuleOfThree) {
  Uav uav = test_uav("alpha", {});
  // Its axis along x.
  uav.body.collisions[0].X_LC = {{1.0, 2.0, 3.0}, uav::from_rpy(0.0, std::numbers::pi / 2.0, 0.0)};
  uav.body.collisions[0].geometry = CapsuleGeometry{0.25, 2.0};
  const auto parts = outside_collisions(uav, note);
  ASSERT_EQ(parts.size(), 3u);
  EXPECT_EQ(std::get<CylinderGeometry>(parts[0].geometry).length_m, 2.0);
  EXPECT_EQ(std::get<SphereGeometry>(parts[1].geometry).radius_m, 0.25);
  EXPECT_NEAR(parts[1].X_LC.p.x, 2.0, 1e-12);
  EXPECT_NEAR(parts[2].X_LC.p.x, 0.0, 1e-12);
  EXPECT_NEAR(parts[2].X_LC.p.z, 3.0, 1e-12);
  EXPECT_EQ((std::set{parts[0].name, parts[1].name, parts[2].name}).size(), 3u);
  EXPECT_THAT(warnings, ElementsAre());
}

TEST_F(OutsideShapes, MakeAnEllipsoidASphereAndSayIt) {
  Uav uav = test_uav("alpha", {});
  uav.body.visuals[0].geometry = EllipsoidGeometry{{1.0, 2.0, 4.0}};
  const auto visuals = outside_visuals(uav, note);
  EXPECT_DOUBLE_EQ(std::get<SphereGeometry>(visuals.at(0).geometry).radius_m, 2.0);
  EXPECT_THAT(warnings, ElementsAre(AllOf(HasSubstr("'alpha'"), HasSubstr("'box'"))));
  warnings.clear();
  uav.body.visuals[0].geometry = EllipsoidGeometry{{2.0, 2.0, 2.0}};
  outside_visuals(uav, note);
  EXPECT_THAT(warnings, ElementsAre()) << "a ball";
}

TEST_F(OutsideShapes, HaveNamesOfTheirOwnWithoutColons) {
  Uav uav = test_uav("alpha", {});
  for (const char* name : {"arm::box", "leg::box"}) {
    uav.body.visuals.push_back(uav.body.visuals[0]);
    uav.body.visuals.back().name = name;
  }
  std::set<std::string> names;
  for (const Visual& visual : outside_visuals(uav, note)) {
    EXPECT_TRUE(names.insert(visual.name).second) << visual.name;
    EXPECT_EQ(visual.name.find(':'), std::string::npos);
  }
}

}  // namespace
}  // namespace tether::sim
