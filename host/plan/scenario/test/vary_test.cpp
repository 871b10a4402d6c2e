#include "test_files.h"

#include <cmath>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base/units.h>
#include <tether/scenario/scenario.h>

namespace tether::scenario {
namespace {

using ::testing::HasSubstr;
using uav::Vec3;

sim::Model box(const std::string& name, const Vec3& p_WM, const Vec3& size_m, bool is_static) {
  sim::Model model{name, {p_WM, {}}, is_static, {{}}};
  model.links[0].collisions.push_back({"box", {}, sim::BoxGeometry{size_m}, 0.5});
  model.links[0].visuals.push_back({"box", {}, sim::BoxGeometry{size_m}, {}, true});
  return model;
}

/// A floor, a crate that stands on it, a pillar 3 m further, and a UAV with a sensor.
sim::World world() {
  sim::World world;
  world.models = {box("floor", {0.0, 0.0, -0.05}, {40.0, 40.0, 0.1}, true),
                  box("crate", {2.0, 0.0, 0.5}, {1.0, 1.0, 1.0}, true),
                  box("pillar", {5.0, 0.0, 1.0}, {1.0, 1.0, 2.0}, true)};
  world.lights.push_back({});
  sim::Uav uav;
  uav.name = "alpha";
  uav.X_WB.p = {0.0, 0.0, 1.0};
  uav.airframe.mass_kg = 2.0;
  uav.airframe.thrust_coefficient = 4.0;
  uav.airframe.rotors.resize(4);
  uav.airframe.max_rotor_speed_rad_s = 2.0;  // 64 N
  uav.body.mass_kg = 2.0;
  uav.body.collisions.push_back({"box", {}, sim::BoxGeometry{{0.4, 0.4, 0.1}}, 1.0});
  uav.sensors.push_back({"imu", {}, 0.0, sim::ImuModel{}});
  world.uavs = {uav};
  world.anchors.push_back({{.name = "crate", .size_m = {}, .color_rgb = {}}, world.models[1].X_WM});
  return world;
}

Variation of(const std::string& quantity, const std::string& owner, Distribution distribution) {
  return {quantity, quantity, owner, std::move(distribution), {"s.toml", 7}};
}

double value(const std::vector<Varied>& values, const std::string& name) {
  return std::ranges::find(values, name, &Varied::name)->value;
}

TEST(Vary, PathsAndWindVaryWhereThereAreAny) {
  sim::World moving = world();
  moving.wind.v_WA_m_s = {2.0, 0.0, 0.0};
  moving.models[2].path =
      sim::DrivenPath{{{{{}, {}, 0.0}, {std::chrono::seconds(2), {0, 3, 0}, 0.0}}}, {}};
  const std::vector<Variation> all = {
      of("path_delay_s", "pillar", OneOf{{0.5}}), of("path_time_factor", "pillar", OneOf{{3.0}}),
      of("wind_factor", "", OneOf{{2.0}}), of("wind_yaw_deg", "", OneOf{{90.0}})};
  sim::World changed = moving;
  vary(all, 1, false, changed);
  EXPECT_EQ(changed.models[2].path->delay, std::chrono::milliseconds(500));
  EXPECT_EQ(changed.models[2].path->waypoints[1].at, std::chrono::seconds(6));
  EXPECT_LT(norm(changed.wind.v_WA_m_s - Vec3{0.0, 4.0, 0.0}), 1e-12);
  for (const Variation& one : all) {
    sim::World still = world();
    EXPECT_THROW(vary({one}, 1, false, still), Error) << one.quantity;
  }
  EXPECT_THROW(vary({of("path_time_factor", "pillar", OneOf{{0.001}})}, 1, false, moving), Error)
      << "1,500 m/s";
  EXPECT_THROW(vary({of("turbulence_factor", "", OneOf{{2.0}})}, 1, false, moving), Error)
      << "a steady wind";
}

TEST(Vary, EachDistributionHasItsMoments) {
  const std::vector<Variation> all = {of("start_x_m", "", Uniform{1.0, 3.0}),
                                      of("start_y_m", "", Normal{-1.0, 0.5}),
                                      of("start_z_m", "", OneOf{{1.0, 4.0}})};
  constexpr int kSeeds = 4000;
  std::map<std::string, double> sum, squares;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    sim::World flown = world();
    for (const Varied& varied : vary(all, seed, false, flown)) {
      sum[varied.name] += varied.value;
      squares[varied.name] += varied.value * varied.value;
    }
  }
  const auto expect = [&](const std::string& name, double mean, double stddev) {
    const double got = sum[name] / kSeeds;
    EXPECT_NEAR(got, mean, 5.0 * stddev / std::sqrt(kSeeds)) << name;
    EXPECT_NEAR(std::sqrt(squares[name] / kSeeds - got * got), stddev, 0.03 * stddev) << name;
  };
  expect("start_x_m", 2.0, 1.0 / std::sqrt(3.0));
  expect("start_y_m", -1.0, 0.5);
  expect("start_z_m", 2.5, 1.5);
}

TEST(Vary, TheSeedAloneDecides) {
  const std::vector<Variation> all = {of("start_x_m", "", Uniform{0.0, 1.0}),
                                      of("mass_factor", "", Uniform{0.9, 1.1})};
  sim::World a = world(), b = world(), c = world();
  const auto first = vary(all, 5, false, a);
  EXPECT_EQ(first, vary(all, 5, false, b));
  EXPECT_NE(first, vary(all, 6, false, c));
  EXPECT_EQ(value(vary({all[1]}, 5, false, c), "mass_factor"), value(first, "mass_factor"))
      << "whatever else varies";
}

TEST(Vary, QuantitiesOfUavsChangeTheirUav) {
  sim::World flown = world();
  const auto is = [](double value) { return OneOf{{value}}; };
  vary({of("start_y_m", "alpha", is(0.5)), of("start_yaw_deg", "", is(90.0)),
        of("mass_factor", "", is(1.5)), of("thrust_factor", "", is(2.0))},
       1, false, flown);
  const sim::Uav& uav = flown.uavs[0];
  EXPECT_EQ(uav.X_WB.p, (Vec3{0.0, 0.5, 1.0}));
  EXPECT_NEAR(uav::yaw_rad(uav.X_WB.q), rad_from_deg(90.0), 1e-12);
  EXPECT_EQ(uav.airframe.mass_kg, 3.0);
  EXPECT_EQ(uav.body.mass_kg, 3.0);
  EXPECT_EQ(uav.airframe.thrust_coefficient, 8.0);
  sim::World loaded = world();
  vary({of("payload_kg", "", is(0.5))}, 1, false, loaded);
  EXPECT_EQ(loaded.uavs[0].body.mass_kg, 2.5);
}

TEST(Vary, AnAnchorMovesWithItsModel) {
  sim::World flown = world();
  vary({of("model_y_m", "crate", OneOf{{2.0}})}, 1, false, flown);
  EXPECT_EQ(flown.models[1].X_WM.p, (Vec3{2.0, 2.0, 0.5}));
  EXPECT_EQ(flown.anchors[0].X_WA.p, (Vec3{2.0, 2.0, 0.5}));
  flown.anchors[0] = {{.name = "alpha", .size_m = {}, .color_rgb = {}}, flown.uavs[0].X_WB};
  vary({of("start_y_m", "alpha", OneOf{{0.5}})}, 1, false, flown);
  EXPECT_EQ(flown.anchors[0].X_WA.p, flown.uavs[0].X_WB.p);
}

// A driven part of a model that turns about itself: it stays where it is in the model.
TEST(Vary, ADrivenPartTurnsAboutItsOwnOriginAfterItsModelMoved) {
  sim::World flown = world();
  sim::Model lid = box("crate::lid", {2.0, 0.3, 1.5}, {0.2, 0.2, 0.1}, false);
  lid.path = sim::DrivenPath{{{{}}}, lid.X_WM.p};
  flown.models.push_back(lid);
  vary({of("model_y_m", "crate", OneOf{{2.0}}), of("model_yaw_deg", "crate", OneOf{{90.0}})}, 1,
       false, flown);
  const sim::Model& moved = flown.models.back();
  EXPECT_LT(norm(moved.X_WM.p - Vec3{1.7, 2.0, 1.5}), 1e-12);
  EXPECT_LT(norm(moved.path->p_WO - moved.X_WM.p), 1e-12);
}

// The crate may stand on the floor, as in the file, but not in the pillar or the UAV.
TEST(Vary, ModelsFindAPlaceWhereTheyTouchNothingNew) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    sim::World flown = world();
    vary({of("model_x_m", "crate", Uniform{-3.0, 4.0})}, seed, false, flown);
    const double x_m = flown.models[1].X_WM.p.x;
    EXPECT_GT(std::abs(x_m - 5.0), 1.0) << "the pillar";
    EXPECT_GT(std::abs(x_m), 0.7) << "the UAV";
  }
  sim::World full = world();
  const Error error = bad_file_error([&] {
    vary({of("model_x_m", "crate", Uniform{2.9, 3.1})}, 1, false, full);
  });
  EXPECT_THAT(error.what(), HasSubstr("finds no place for the model 'crate'"));
  EXPECT_EQ(error.where().line, 7);
}

// The UAV may stand on the crate, but not start in it, below the floor, or in another UAV.
TEST(Vary, UavsStartWhereTheyAreInNothingNew) {
  const std::vector<Variation> start = {of("start_x_m", "alpha", Uniform{-3.0, 3.0}),
                                        of("start_z_m", "alpha", Uniform{-2.0, 0.5})};
  sim::World two = world();
  two.uavs.push_back(two.uavs[0]);
  two.uavs[1].name = "beta";
  two.uavs[1].X_WB.p = {-2.0, 0.0, 0.5};
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    sim::World flown = two;
    vary(start, seed, false, flown);
    const Vec3& p = flown.uavs[0].X_WB.p;
    EXPECT_GT(p.z, 0.05 - 1e-9) << "the floor";
    EXPECT_TRUE(std::abs(p.x - 2.0) > 0.7 || p.z > 1.05 - 1e-3) << "the crate";
    EXPECT_TRUE(std::abs(p.x + 2.0) > 0.4 || std::abs(p.z - 0.5) > 0.1) << "beta";
  }
  sim::World full = world();
  const Error error = bad_file_error([&] {
    vary({of("start_x_m", "alpha", Uniform{1.9, 2.1}), of("start_z_m", "alpha", OneOf{{-0.5}})}, 1,
         false, full);
  });
  EXPECT_THAT(error.what(), HasSubstr("finds no place for the UAV 'alpha'"));
  EXPECT_EQ(error.where().line, 7);
}

// The crate drives from where it stands in its file; at ST 0 it is 3 m before that.
TEST(Vary, UavsStartBesideWhereADrivenModelBegins) {
  const auto x_m = [](double low, double high) {
    sim::World flown = world();
    flown.models[1].is_static = false;
    flown.models[1].path =
        sim::DrivenPath{{{{Duration{0}, {-3.0, 0.0, 0.0}, 0.0}}}, flown.models[1].X_WM.p};
    vary({of("start_x_m", "alpha", Uniform{low, high}), of("start_z_m", "alpha", OneOf{{-0.5}})}, 1,
         false, flown);
    return flown.uavs[0].X_WB.p.x;
  };
  EXPECT_GT(x_m(1.9, 2.1), 1.9);
  EXPECT_THROW(x_m(-1.1, -0.9), Error);
}

TEST(Vary, LightAndFrictionAreThoseOfTheWholeWorld) {
  sim::World flown = world();
  vary({of("light_factor", "", OneOf{{0.5}}), of("friction_factor", "", OneOf{{2.0}})}, 1, false,
       flown);
  EXPECT_EQ(flown.lights[0].diffuse_rgb.x, 0.5);
  EXPECT_EQ(flown.ambient_rgb.x, 0.2);
  EXPECT_EQ(flown.models[2].links[0].collisions[0].friction, 1.0);
}

TEST(Vary, ColoursTurnFadeAndStayColours) {
  const auto colour = [](const std::string& quantity, double value, const Vec3& before) {
    sim::World flown = world();
    flown.models[1].links[0].visuals[0].material.diffuse_rgb = before;
    vary({of(quantity, "crate", OneOf{{value}})}, 1, false, flown);
    return flown.models[1].links[0].visuals[0].material.diffuse_rgb;
  };
  const auto near = [](const Vec3& a, const Vec3& b) { return norm(a - b) < 1e-12; };
  EXPECT_TRUE(near(colour("model_hue_deg", 120, {0.6, 0.1, 0.2}), {0.2, 0.6, 0.1}));
  EXPECT_TRUE(near(colour("model_hue_deg", 360, {0.6, 0.1, 0.2}), {0.6, 0.1, 0.2}));
  EXPECT_TRUE(near(colour("model_hue_deg", 60, {0.5, 0.5, 0.5}), {0.5, 0.5, 0.5})) << "a grey";
  EXPECT_TRUE(near(colour("model_hue_deg", 60, {1, 0, 0}), {2.0 / 3.0, 2.0 / 3.0, 0}));
  EXPECT_TRUE(near(colour("model_saturation_factor", 0.5, {0.6, 0.2, 0.1}), {0.45, 0.25, 0.2}));
  EXPECT_TRUE(near(colour("model_saturation_factor", 9, {0.6, 0.2, 0.1}), {1, 0, 0}));
}

TEST(Vary, WarmLightIsRedder) {
  sim::World flown = world();
  vary({of("light_warmth_factor", "", OneOf{{4.0}})}, 1, false, flown);
  EXPECT_EQ(flown.lights[0].diffuse_rgb, (Vec3{2.0, 1.0, 0.5}));
  EXPECT_EQ(flown.ambient_rgb, (Vec3{0.8, 0.4, 0.2}));
}

TEST(Vary, MountingsChangeAfterTheProfiles) {
  const std::vector<Variation> all = {of("sensor_yaw_deg", "alpha.imu", OneOf{{10.0}})};
  sim::World flown = world();
  const auto values = vary(all, 1, false, flown);
  EXPECT_EQ(flown.uavs[0].sensors[0].X_BS.q, uav::Quat{});
  vary_mountings(all, values, flown);
  EXPECT_NEAR(uav::yaw_rad(flown.uavs[0].sensors[0].X_BS.q), rad_from_deg(10.0), 1e-12);
}

TEST(Vary, RefusesWhatItCannotChange) {
  const auto problem = [&](const Variation& variation, bool is_read_elsewhere = false) {
    return std::string(bad_file_error([&] {
                         sim::World flown = world();
                         const auto values = vary({variation}, 1, is_read_elsewhere, flown);
                         vary_mountings({variation}, values, flown);
                       }).what());
  };
  EXPECT_THAT(problem(of("start_x_m", "beta", Uniform{})), HasSubstr("'beta', which does not"));
  EXPECT_THAT(problem(of("model_x_m", "crat", Uniform{})), HasSubstr("did you mean 'crate'"));
  EXPECT_THAT(problem(of("sensor_x_m", "imu", Uniform{})), HasSubstr("UAV.SENSOR"));
  EXPECT_THAT(problem(of("sensor_x_m", "alpha.eye", Uniform{})), HasSubstr("the sensor 'eye'"));
  EXPECT_THAT(problem(of("mass_factor", "", OneOf{{0.0}})), HasSubstr("must be greater than 0"));
  EXPECT_THAT(problem(of("payload_kg", "", OneOf{{-2.0}})), HasSubstr("a mass of 0 kg"));
  EXPECT_THAT(problem(of("payload_kg", "", OneOf{{5.0}})), HasSubstr("too heavy to fly"));
  EXPECT_THAT(problem(of("thrust_factor", "", OneOf{{0.2}})), HasSubstr("12.8 N at most"));
  EXPECT_THAT(problem(of("light_factor", "", OneOf{{2.0}}), true), HasSubstr("reads the world"));
}

// The file.

class VaryTables : public testing::Test {
 protected:
  Scenario load(const std::string& tables, const std::vector<Setting>& settings = {}) const {
    return load_scenario(write_project(scratch_, kFullScenario + tables), settings);
  }
  ScratchFolder scratch_;
};

TEST_F(VaryTables, SayWhatVariesAndHow) {
  const auto variations = load(
                              "[vary.start]\nquantity = \"start_x_m\"\nuniform = [-0.5, 0.5]\n"
                              "[vary.weight]\nquantity = \"mass_factor\"\nof = \"uav1\"\n"
                              "normal = [1, 0.1]\n")
                              .variations;
  ASSERT_EQ(variations.size(), 2U);
  EXPECT_EQ(variations[0].text(), "start_x_m");
  EXPECT_EQ(std::get<Uniform>(variations[0].distribution).least, -0.5);
  EXPECT_EQ(variations[1].text(), "mass_factor of uav1");
  EXPECT_EQ(std::get<Normal>(variations[1].distribution).stddev, 0.1);
}

TEST_F(VaryTables, ASettingHoldsOneQuantity) {
  const std::string tables = "[vary.start]\nquantity = \"start_x_m\"\nuniform = [-0.5, 0.5]\n";
  const auto held = load(tables, {{"vary.start.value", "0.25"}}).variations;
  EXPECT_EQ(std::get<OneOf>(held[0].distribution).values, std::vector{0.25});
  EXPECT_EQ(load(tables, {{"vary.start.of", "uav1"}}).variations[0].of, "uav1");
  EXPECT_THROW(load(tables, {{"vary.other.value", "0.25"}}), Error);
}

TEST_F(VaryTables, RefuseMistakesAtTheirLine) {
  const int line = 1 + static_cast<int>(std::ranges::count(kFullScenario, '\n'));
  const auto refused = [&](const std::string& tables, int after, const std::string& subject) {
    expect_refusal(line + after, subject, [&] { load(tables); });
  };
  refused("[vary.a]\nquantity = \"start_w_m\"\nuniform = [0, 1]\n", 1, "quantity");
  refused("[vary.a]\nquantity = \"start_x_m\"\n", 0, "[vary.a]");
  refused("[vary.a]\nquantity = \"start_x_m\"\nuniform = [0, 1]\nnormal = [0, 1]\n", 3, "normal");
  refused("[vary.a]\nquantity = \"start_x_m\"\nuniform = [1, 0]\n", 2, "uniform");
  refused("[vary.a]\nquantity = \"start_x_m\"\nnormal = [1, -1]\n", 2, "normal");
  refused("[vary.a]\nquantity = \"model_x_m\"\nuniform = [0, 1]\n", 0, "of");
  refused("[vary.a]\nquantity = \"path_delay_s\"\nof = \"m\"\nvalue = -100\n", 3, "value");
  refused("[vary.a]\nquantity = \"mass_factor\"\nnormal = [-1, 1]\n", 2, "normal");
  refused("[vary.a]\nquantity = \"mass_factor\"\nuniform = [0, 1]\n", 2, "uniform");
  EXPECT_EQ(load("[vary.a]\nquantity = \"wind_factor\"\nuniform = [0, 1]\n").variations.size(), 1U)
      << "there may be none";
  refused("[vary.a]\nquantity = \"sensor_pitch_deg\"\nof = \"a.b\"\none_of = [9, 1e3]\n", 3,
          "one_of");
}

}  // namespace
}  // namespace tether::scenario
