#include "header_facts.h"

#include "coordinator_fixture.h"

#include <cmath>

#include <gtest/gtest.h>

namespace tether::coordinator {
namespace {

class HeaderTest : public CoordinatorTest {};

TEST(HeaderFacts, TheExtentReachesToTheFarthestPointOfAnyShape) {
  sim::Link body;
  EXPECT_EQ(extent_m(body), 0.0);
  body.collisions.push_back({.name = "arm", .X_LC = {}, .geometry = sim::BoxGeometry{{6, 0, 8}}});
  EXPECT_DOUBLE_EQ(extent_m(body), 5.0);
  body.collisions.push_back({.name = "foot", .X_LC = {}, .geometry = sim::SphereGeometry{1.0}});
  body.collisions.back().X_LC.p = {0, 6, 0};
  EXPECT_DOUBLE_EQ(extent_m(body), 7.0);
  body.collisions.push_back({.name = "hull", .X_LC = {}, .geometry = sim::MeshGeometry{}});
  EXPECT_EQ(extent_m(body), 0.0) << "its vertices are not known";
}

TEST(HeaderFacts, OneModelThatIsNotStaticCanMove) {
  sim::World world;
  world.models.emplace_back().is_static = true;
  EXPECT_TRUE(only_uavs_move(world));
  world.models.emplace_back();
  EXPECT_FALSE(only_uavs_move(world));
}

TEST(HeaderFacts, ARadioHasTheSettingsOfItsModelOnly) {
  radio::Settings settings;
  EXPECT_EQ(describe(settings).model, "ideal");
  EXPECT_EQ(describe(settings).access, "");
  settings.model = radio::Model::kDistribution;
  settings.delay = Duration(5);
  settings.drawn_delay = uav::EmpiricalDelay{{Duration(30), Duration(20)}};
  EXPECT_EQ(describe(settings).access, "");
  EXPECT_EQ(describe(settings).least_delay, Duration(25));
  EXPECT_EQ(describe(settings).most_delay, Duration(35));
  settings.drawn_delay = uav::NormalDelay{Duration(30), Duration(20)};
  EXPECT_EQ(describe(settings).least_delay, Duration(5));
  EXPECT_EQ(describe(settings).most_delay, Duration::max());
  settings.model = radio::Model::kLogDistance;
  settings.access = radio::Access::kTdma;
  EXPECT_EQ(describe(settings).access, "tdma");
  EXPECT_EQ(describe(settings).tx_power_dbm, settings.tx_power_dbm);
}

TEST_F(HeaderTest, SaysWhatAUavCarriesAndWhen) {
  sim::World world = sim::make_fake_world(2);
  world.gravity_m_s2 = 9.5;
  world.uavs[1].airframe.mass_kg = 0.8;
  world.uavs[1].payloads = {
      {.mass_kg = 0.2, .from = SimTime(Duration(1)), .until = SimTime(Duration(3))}};
  make(std::move(world));
  server_->add_sut(hello("uav0"), {finish(Duration(0))});
  server_->add_sut(hello("uav1"), {finish(Duration(0))});
  run();
  for (const record::SutInfo& sut : recorder_.header.suts) {
    if (sut.uav == "uav0") {
      EXPECT_EQ(sut.load, std::nullopt);
    } else {
      EXPECT_EQ(sut.load,
                (record::LoadInfo{0.8, 9.5, {{0.2, SimTime(Duration(1)), SimTime(Duration(3))}}}));
    }
  }
}

TEST_F(HeaderTest, SaysWhichUavAnAnchorIs) {
  sim::World world = sim::make_fake_world(2);
  world.anchors[0].anchor.name = "uav1";
  world.anchors[0].X_WA.p = world.uavs[1].X_WB.p + uav::Vec3{0, 0, 0.25};
  make(std::move(world));
  server_->add_sut(hello("uav0"), {finish(Duration(0))});
  server_->add_sut(hello("uav1"), {finish(Duration(0))});
  run();
  EXPECT_EQ(recorder_.header.anchors.at(0).uav, "uav1");
  EXPECT_EQ(recorder_.header.anchors.at(0).p_BA_m[2], 0.25);
}

}  // namespace
}  // namespace tether::coordinator
