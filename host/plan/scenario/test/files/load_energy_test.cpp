#include <string>

#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/base_testing/thrown_error.h>
#include <tether/scenario/scenario.h>
#include <tether/sim_sdf/load_world.h>

namespace tether::scenario {
namespace {

const std::string kGood =
    "name = \"e\"\n"
    "[rotor]\nradius_m = 0.1\nefficiency = 0.7\nnominal_voltage_v = 11.1\n"
    "[battery]\ncells = 3\ncapacity_ah = 2\ncharge = [0, 0.5, 1]\n"
    "cell_voltage_v = [3.3, 3.7, 4.2]\nresistance_ohm = 0.05\ncut_off_cell_v = 3\n"
    "[computer]\nidle_w = 2.3\nbusy_core_w = 0.8\n"
    "[constant]\nsensors_w = 1\nradio_w = 0.5\n";

std::string with(const std::string& found, const std::string& replacement) {
  std::string text = kGood;
  return text.replace(text.find(found), found.size(), replacement);
}

class LoadEnergy : public testing::Test {
 protected:
  Energy load(const std::string& text) { return load_energy(scratch_.write("energy.toml", text)); }
  ScratchFolder scratch_;
};

TEST_F(LoadEnergy, ReadsAllParts) {
  const Energy energy = load(kGood);
  EXPECT_TRUE(energy.has_battery);
  EXPECT_DOUBLE_EQ(energy.model.battery.capacity_C, 7200.0);
  EXPECT_DOUBLE_EQ(energy.model.battery.cut_off_V, 9.0);
  EXPECT_DOUBLE_EQ(energy::open_circuit_voltage_V(energy.model.battery, 1.0), 12.6);
  EXPECT_DOUBLE_EQ(energy.model.computer.busy_core_W, 0.8);
  EXPECT_DOUBLE_EQ(energy.model.sensors_W, 1.5);
  EXPECT_EQ(energy.battery_at.line, 6);
}

TEST_F(LoadEnergy, RefusesWhatCannotBe) {
  struct Case {
    std::string text, subject;
    int line;
  };
  for (const Case& bad : {
           Case{with("capacity_ah = 2\n", "capacity_ah = 0\n"), "capacity_ah", 8},
           Case{with("cells = 3", "cells = 0"), "cells", 7},
           Case{with("[0, 0.5, 1]", "[0.1, 0.5, 1]"), "charge", 9},
           Case{with("[0, 0.5, 1]", "[0, 0.5, 0.5, 1]"), "charge", 9},
           Case{with("[3.3, 3.7, 4.2]", "[3.3, 4.2]"), "cell_voltage_v", 10},
           Case{with("[3.3, 3.7, 4.2]", "[3.3, 4.2, 3.7]"), "cell_voltage_v", 10},
           Case{with("resistance_ohm = 0.05", "resistance_ohm = -1"), "resistance_ohm", 11},
           Case{with("cut_off_cell_v = 3\n", "cut_off_cell_v = 4.2\n"), "cut_off_cell_v", 12},
           Case{with("efficiency = 0.7", "efficiency = 1.1"), "efficiency", 4},
           Case{with("radio_w", "radio"), "radio", 18},
       }) {
    const Error error = bad_file_error([&] { load(bad.text); });
    EXPECT_EQ(error.subject(), bad.subject);
    EXPECT_EQ(error.where().line, bad.line) << bad.subject;
  }
}

class ResolveEnergy : public LoadEnergy {
 protected:
  ResolveEnergy() : scenario_(load_scenario(shipped("inspect_room"))) {
    world_ = sim::load_world(world_request(scenario_, 1), {});
  }
  static std::filesystem::path shipped(const std::string& name) {
    return std::filesystem::path(TETHER_SOURCE_DIR) / "data/scenarios" / (name + ".toml");
  }
  const energy::Model& resolve(const std::string& text) {
    scenario_.uavs[0].energy = load(text);
    resolve_energy(scenario_, scenario_.conditions[0], world_, {});
    return *world_.uavs[0].energy;
  }
  Scenario scenario_;
  sim::World world_;
};

TEST_F(ResolveEnergy, TakesThePowerOfTheTarget) {
  EXPECT_DOUBLE_EQ(resolve(kGood).computer.idle_W, 2.3);
  scenario_.conditions[0].computers[0].target.emplace().power = {
      {.idle_W = 5.0, .busy_core_W = 2.0}};
  EXPECT_DOUBLE_EQ(resolve(kGood).computer.idle_W, 5.0);
}

TEST_F(ResolveEnergy, RefusesABatteryThatCannotLiftTheUav) {
  const std::string weak = with("resistance_ohm = 0.05", "resistance_ohm = 1");
  EXPECT_EQ(bad_file_error([&] { resolve(weak); }).subject(), "battery");
  EXPECT_EQ(bad_file_error([&] { resolve(with("radius_m = 0.1", "radius_m = 0.05")); }).subject(),
            "rotor");
}

TEST_F(ResolveEnergy, TakesTheBatteryOfTheModelIfTheFileHasNone) {
  std::string text = kGood;
  text.erase(text.find("[battery]"), text.find("[computer]") - text.find("[battery]"));
  EXPECT_EQ(bad_file_error([&] { resolve(text); }).subject(), "battery");
  world_.uavs[0].battery = load(kGood).model.battery;
  EXPECT_DOUBLE_EQ(resolve(text).battery.capacity_C, 7200.0);
}

}  // namespace
}  // namespace tether::scenario
