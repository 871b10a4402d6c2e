#include "commands.h"

#include <filesystem>
#include <sstream>
#include <utility>

#include <gmock/gmock.h>
#include <toml++/toml.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/rig/interruptible_vehicle.h>
#include <tether/tasks/testing/planar_vehicle.h>

namespace tether::sut {
namespace {

namespace fs = std::filesystem;
using tasks::testing::PlanarVehicle;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class Commands : public ::testing::Test {
 protected:
  /// What a command is given; the fake stays to be asked.
  Connection connection(const PlanarVehicle::Options& options, bool is_real) {
    auto vehicle = std::make_unique<PlanarVehicle>(options);
    vehicle_ = vehicle.get();
    return {std::move(vehicle), {is_real ? "real sensor" : "virtual", "bench"}, is_real};
  }
  std::string path(const std::string& name) const { return folder_.path(name).string(); }
  std::string out() const { return out_.str(); }
  std::string err() const { return err_.str(); }
  bool is_empty() const { return fs::is_empty(folder_.path()); }

  ScratchFolder folder_;
  PlanarVehicle* vehicle_ = nullptr;
  std::ostringstream out_, err_;
  Streams streams_{out_, err_};
};

CommandLine characterize_line(const std::string& out) {
  CommandLine line;
  line.characterize.emplace();
  line.characterize->acquisitions = 5;
  line.characterize->out = out;
  return line;
}

CommandLine real_row_line() {
  CommandLine line;
  rig::TaskSpec spec;
  spec.options = tasks::RelativePositionOptions{.convergence = {.tolerance_px = 2.0}};
  spec.anchor = "blue_box";
  line.mission.tasks = {spec};
  return line;
}

TEST_F(Commands, CharacterizeWritesAProfileAndPrintsTheTables) {
  const Connection virtual_uav = connection({}, false);
  EXPECT_EQ(characterize_command(characterize_line(path("p.toml")), virtual_uav, streams_), 0);
  EXPECT_THAT(out(), AllOf(HasSubstr("Table I"), HasSubstr("\nvirtual        bench"),
                           HasSubstr("[ms]           n"), HasSubstr("\"range_mean_s\":0.03")));
  EXPECT_EQ(err(), "");
  ASSERT_TRUE(vehicle_->finished());
  EXPECT_TRUE(vehicle_->finished()->reached_goal);
  EXPECT_THAT(vehicle_->finished()->details_json, HasSubstr("\"camera_p95_s\""));
  ::toml::table profile = ::toml::parse_file(path("p.toml"));
  const auto* samples = profile["sensors"]["range"]["delay"]["samples_ms"].as_array();
  ASSERT_NE(samples, nullptr);
  EXPECT_EQ(samples->size(), 5u);
  EXPECT_EQ(samples->at(0).value<double>(), 30.0);
}

// One board, one command, one profile.
TEST_F(Commands, EachSensorGetsTheModelThatItAllows) {
  const Connection virtual_uav = connection({}, false);
  EXPECT_EQ(characterize_command(characterize_line(path("p.toml")), virtual_uav, streams_), 0);
  ::toml::table profile = ::toml::parse_file(path("p.toml"));
  const auto timing = [&](const char* sensor) {
    return profile["sensors"][sensor]["timing"].value<std::string>();
  };
  EXPECT_EQ(timing("camera"), "periodic");
  EXPECT_EQ(timing("imu"), "periodic");
  EXPECT_EQ(timing("range"), "on_demand");
  EXPECT_THAT(out(),
              HasSubstr("\nTiming models: camera periodic, imu periodic, range on_demand\n"));
}

TEST_F(Commands, ASensorThatIsNotPeriodicFallsBackAndSaysWhy) {
  const Connection real = connection({.image_delay = Duration(0)}, true);
  CommandLine line = characterize_line(path("p.toml"));
  line.characterize->sensors = {"camera"};
  line.rig = devices::Rig{"rig", {}, {}};
  EXPECT_EQ(characterize_command(line, real, streams_), 0);
  EXPECT_THAT(out(), HasSubstr("\nTiming models: camera on_demand\n"));
  EXPECT_THAT(err(), AllOf(HasSubstr("tether-sut: sensor \"camera\": "),
                           ::testing::EndsWith("; its model is on_demand\n")));
  EXPECT_EQ(::toml::parse_file(path("p.toml"))["sensors"]["camera"]["timing"].value<std::string>(),
            "on_demand");
}

// Its images' instants pass at a third of its clock's pace.
TEST_F(Commands, WithoutSynchronisationThereIsNoPeriodicProfile) {
  const auto run = [&](calibration::Timing timing) {
    const Connection unsynchronised = connection({.clock_factor = 3.0}, false);
    CommandLine line = characterize_line(path("p.toml"));
    line.characterize->sensors = {"camera"};
    line.characterize->acquisitions = 30;
    line.characterize->timing = timing;
    return characterize_command(line, unsynchronised, streams_);
  };
  EXPECT_EQ(run(calibration::Timing::kPeriodic), 2);
  EXPECT_TRUE(is_empty());
  EXPECT_EQ(out(), "");
  EXPECT_THAT(err(), HasSubstr("\"camera\""));
  EXPECT_EQ(run(calibration::Timing::kAuto), 0);
  EXPECT_EQ(::toml::parse_file(path("p.toml"))["sensors"]["camera"]["timing"].value<std::string>(),
            "on_demand");
}

TEST_F(Commands, CharacterizePeriodicSensors) {
  const Connection virtual_uav = connection({}, false);
  CommandLine line = characterize_line(path("p.toml"));
  line.characterize->sensors = {"camera"};
  line.characterize->timing = calibration::Timing::kPeriodic;
  EXPECT_EQ(characterize_command(line, virtual_uav, streams_), 0);
  ::toml::table profile = ::toml::parse_file(path("p.toml"));
  EXPECT_EQ(profile["sensors"]["camera"]["period_ms"].value<double>(), 33.333333);
  EXPECT_EQ(profile["sensors"]["camera"]["delay"]["samples_ms"][0].value<double>(), 20.0);
  EXPECT_THAT(out(),
              AllOf(HasSubstr("camera period  1  33.333"), HasSubstr("camera delay   4  20.000")));
}

TEST_F(Commands, ADeviceThatStopsLeavesNoProfile) {
  const Connection real = connection({.disconnect_at = 7}, true);
  EXPECT_EQ(characterize_command(characterize_line(path("p.toml")), real, streams_), 3);
  EXPECT_TRUE(is_empty());
  EXPECT_EQ(out(), "");
  EXPECT_EQ(err(), "tether-sut: the connection to the coordinator ended\n");
  EXPECT_FALSE(vehicle_->finished());
}

// Six measurements are made, the first of which is not counted.
TEST_F(Commands, AnInterruptLeavesEitherAProfileOrNone) {
  for (const int readings_before : {0, 5, 6}) {
    Connection real = connection({}, true);
    real.vehicle = rig::make_interruptible(
        std::move(real.vehicle),
        [readings_before, asked = 0]() mutable { return asked++ >= readings_before; });
    CommandLine line = characterize_line(path("p.toml"));
    line.characterize->sensors = {"range"};
    const bool is_done = readings_before == 6;
    EXPECT_EQ(characterize_command(line, real, streams_), is_done ? 0 : 1);
    EXPECT_EQ(fs::exists(path("p.toml")), is_done);
    EXPECT_EQ(vehicle_->finished().has_value(), is_done);
  }
}

TEST_F(Commands, TooFewAcquisitionsAreNoProfileButAnOutcome) {
  const Connection virtual_uav = connection({}, false);
  CommandLine line = characterize_line(path("p.toml"));
  line.characterize->time_limit = Duration(1);
  EXPECT_EQ(characterize_command(line, virtual_uav, streams_), 1);
  EXPECT_TRUE(is_empty());
  ASSERT_TRUE(vehicle_->finished());
  EXPECT_FALSE(vehicle_->finished()->reached_goal);
}

TEST_F(Commands, ArrivalsAreNoPeriodicProfile) {
  const Connection real = connection({.image_delay = Duration(0)}, true);
  CommandLine line = characterize_line(path("p.toml"));
  line.characterize->sensors = {"camera"};
  line.characterize->timing = calibration::Timing::kPeriodic;
  line.rig = devices::Rig{"rig", {}, {}};
  EXPECT_EQ(characterize_command(line, real, streams_), 2);
  EXPECT_TRUE(is_empty());
  EXPECT_THAT(err(), HasSubstr("\"camera\""));
}

TEST_F(Commands, ADelayThatNoReaderTakesIsNoProfile) {
  const auto run = [&](const std::string& out) {
    const Connection slow = connection({.range_delays = {std::chrono::seconds(61)}}, false);
    CommandLine line = characterize_line(out);
    line.characterize->sensors = {"range"};
    return characterize_command(line, slow, streams_);
  };
  EXPECT_EQ(run(path("p.toml")), 2);
  EXPECT_TRUE(is_empty());
  EXPECT_THAT(err(), HasSubstr("a delay of 61000.0 ms was measured"));
  EXPECT_EQ(run(""), 0) << "it can be looked at";
}

TEST_F(Commands, AProfileThatCannotBeWrittenFails) {
  const Connection virtual_uav = connection({}, false);
  const CommandLine line = characterize_line(path("gone/p.toml"));
  EXPECT_EQ(characterize_command(line, virtual_uav, streams_), 3);
  EXPECT_FALSE(vehicle_->finished());
}

TEST_F(Commands, WhereNothingCanBeWrittenIsToldBeforeAnythingIsOpened) {
  CommandLine line = characterize_line(path("none/p.toml"));
  line.rig = devices::Rig{"rig", {}, {}};
  EXPECT_EQ(run_command(line, streams_), 2);
  EXPECT_THAT(err(), HasSubstr("none/p.toml: cannot be written"));
}

TEST_F(Commands, RealRowComesBeforeTheJson) {
  const Connection real = connection({.anchor_bearing_rad = 0.0, .anchor_distance_m = 9}, true);
  CommandLine line = real_row_line();
  line.real_row.true_roi = rig::PixelBox{76, 56, 8, 8};
  line.real_row.keep_image = path("i.png");
  EXPECT_EQ(real_row_command(line, real, streams_), 0);
  EXPECT_THAT(
      out(),
      AllOf(HasSubstr("i.png: image 2; the tracked ROI, as --true-roi-px takes it: "),
            HasSubstr("\nreal sensor    bench  "), HasSubstr("\"distance_reference_m\":10.25")));
  EXPECT_EQ(err(), "");
  EXPECT_TRUE(fs::exists(path("i.png")));
  EXPECT_THAT(vehicle_->finished()->details_json, HasSubstr("angle_error_deg"));
}

TEST_F(Commands, RealRowSaysWhatIsMissing) {
  const Connection real = connection({.anchor_is_there = false}, true);
  CommandLine line = real_row_line();
  line.real_row.keep_image = path("i.png");
  EXPECT_EQ(real_row_command(line, real, streams_), 1);
  EXPECT_TRUE(is_empty());
  EXPECT_THAT(err(), HasSubstr("i.png is not written"));
  EXPECT_THAT(out(), AllOf(HasSubstr("\"anchor not seen\""), Not(HasSubstr("Table II"))));
}

TEST_F(Commands, FlyReportsFailuresInOneLine) {
  PlanarVehicle cut({.disconnect_at = 1});
  EXPECT_EQ(fly_command(real_row_line(), cut, streams_), 3);
  EXPECT_EQ(err(), "tether-sut: the connection to the coordinator ended\n");
  PlanarVehicle vehicle({});
  EXPECT_EQ(fly_command(real_row_line(), vehicle, streams_), 0);
  EXPECT_THAT(out(), HasSubstr("\"goal reached\""));
}

}  // namespace
}  // namespace tether::sut
