#include "commands.h"

#include <filesystem>
#include <sstream>
#include <utility>

#include <gmock/gmock.h>
#include <toml++/toml.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/rig/device_arguments.h>
#include <tether/tasks/testing/planar_vehicle.h>

namespace tether::sut {
namespace {

namespace fs = std::filesystem;
using calibration::Timing;
using tasks::testing::PlanarVehicle;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class Commands : public ::testing::Test {
 protected:
  /// A connection with a simulated vehicle, which is also in `vehicle_`.
  Connection connection(const PlanarVehicle::Options& options, bool is_real) {
    auto vehicle = std::make_unique<PlanarVehicle>(options);
    vehicle_ = vehicle.get();
    return {std::move(vehicle), {is_real ? "real sensor" : "virtual", "bench"}, is_real};
  }
  std::string path(const std::string& name) const { return folder_.path(name).string(); }
  std::string out() const { return out_.str(); }
  std::string err() const { return err_.str(); }
  bool is_empty() const { return fs::is_empty(folder_.path()); }
  static bool is_one_line(const std::string& text) {
    return text.starts_with("tether-sut: ") && text.find('\n') == text.size() - 1;
  }
  CommandLine characterize_line() const {
    CommandLine line;
    line.characterize.emplace();
    line.characterize->acquisitions = 5;
    line.characterize->out = path("p.toml");
    return line;
  }
  CommandLine camera_line(Timing timing) const {
    CommandLine line = characterize_line();
    line.characterize->sensors = {"camera"};
    line.characterize->timing = timing;
    return line;
  }
  /// Of the written profile.
  std::optional<std::string> timing(const char* sensor) const {
    return ::toml::parse_file(path("p.toml"))["sensors"][sensor]["timing"].value<std::string>();
  }

  ScratchFolder folder_;
  PlanarVehicle* vehicle_ = nullptr;
  std::ostringstream out_, err_;
  Streams streams_{out_, err_};
};

CommandLine real_row_line() {
  CommandLine line;
  rig::TaskSpec spec;
  spec.options = tasks::RelativePositionOptions{.convergence = {.tolerance_px = 2.0}};
  spec.anchor = "blue_box";
  line.mission.tasks = {spec};
  return line;
}

TEST_F(Commands, CharacterizeWritesAProfileAndPrintsTables) {
  const Connection virtual_uav = connection({}, false);
  EXPECT_EQ(characterize_command(characterize_line(), virtual_uav, streams_), 0);
  EXPECT_THAT(out(), AllOf(HasSubstr("Table I"), HasSubstr("\nvirtual        bench"),
                           HasSubstr("[ms]           n"), HasSubstr("\"range_mean_s\":0.03")));
  EXPECT_EQ(err(), "");
  ASSERT_TRUE(vehicle_->finished());
  EXPECT_TRUE(vehicle_->finished()->reached_goal);
  EXPECT_THAT(vehicle_->finished()->details_json, HasSubstr("\"camera_p95_s\""));
  EXPECT_EQ(timing("camera"), "periodic");
  EXPECT_EQ(timing("imu"), "periodic");
  EXPECT_EQ(timing("range"), "on_demand");
  EXPECT_THAT(out(), HasSubstr(": camera periodic, imu periodic, range on_demand\n"));
  ::toml::table profile = ::toml::parse_file(path("p.toml"));
  const auto* samples = profile["sensors"]["range"]["delay"]["samples_ms"].as_array();
  ASSERT_NE(samples, nullptr);
  EXPECT_EQ(samples->size(), 5u);
  EXPECT_EQ(samples->at(0).value<double>(), 30.0);
}

TEST_F(Commands, CharacterizeAPeriodicSensor) {
  const Connection virtual_uav = connection({}, false);
  EXPECT_EQ(characterize_command(camera_line(Timing::kPeriodic), virtual_uav, streams_), 0);
  ::toml::table profile = ::toml::parse_file(path("p.toml"));
  EXPECT_EQ(profile["sensors"]["camera"]["period_ms"].value<double>(), 33.333333);
  EXPECT_EQ(profile["sensors"]["camera"]["delay"]["samples_ms"][0].value<double>(), 20.0);
  EXPECT_THAT(out(),
              AllOf(HasSubstr("camera period  1  33.333"), HasSubstr("camera delay   4  20.000")));
}

// The times of images from a device may be those of their arrival.
TEST_F(Commands, ASensorWithArrivalTimesIsOnlyOnDemand) {
  const Connection real = connection({.image_delay = Duration(0)}, true);
  CommandLine line = camera_line(Timing::kPeriodic);
  line.rig = devices::Rig{"rig", {}, {}};
  EXPECT_EQ(characterize_command(line, real, streams_), 2);
  EXPECT_TRUE(is_empty());
  EXPECT_THAT(err(), HasSubstr("\"camera\""));
  const Connection again = connection({.image_delay = Duration(0)}, true);
  line.characterize->timing = Timing::kAuto;
  EXPECT_EQ(characterize_command(line, again, streams_), 0);
  EXPECT_EQ(timing("camera"), "on_demand");
}

// The times of images pass at a third of the pace of the clock.
TEST_F(Commands, WithoutSynchronisationASensorIsOnlyOnDemand) {
  for (const Timing timing_asked : {Timing::kPeriodic, Timing::kAuto}) {
    const Connection free_running = connection({.clock_factor = 3.0}, false);
    CommandLine line = camera_line(timing_asked);
    line.characterize->acquisitions = 30;
    const bool is_auto = timing_asked == Timing::kAuto;
    EXPECT_EQ(characterize_command(line, free_running, streams_), is_auto ? 0 : 2);
    EXPECT_EQ(is_empty(), !is_auto);
  }
  EXPECT_EQ(timing("camera"), "on_demand");
}

TEST_F(Commands, WriteNoProfileIfADeviceFails) {
  const Connection real = connection({.disconnect_at = 7}, true);
  EXPECT_EQ(characterize_command(characterize_line(), real, streams_), 3);
  EXPECT_TRUE(is_empty());
  EXPECT_EQ(out(), "");
  EXPECT_TRUE(is_one_line(err()));
  EXPECT_FALSE(vehicle_->finished());
}

// Six measurements are made, the first of which is not counted.
TEST_F(Commands, AnInterruptLeavesAWholeProfileOrNone) {
  for (const int readings_before : {0, 5, 6}) {
    Connection real = connection({}, true);
    real.vehicle = rig::make_interruptible(
        std::move(real.vehicle),
        [readings_before, asked = 0]() mutable { return asked++ >= readings_before; });
    CommandLine line = characterize_line();
    line.characterize->sensors = {"range"};
    const bool is_done = readings_before == 6;
    EXPECT_EQ(characterize_command(line, real, streams_), is_done ? 0 : 1);
    EXPECT_EQ(fs::exists(path("p.toml")), is_done);
    EXPECT_EQ(vehicle_->finished().has_value(), is_done);
  }
}

TEST_F(Commands, TooFewAcquisitionsMissTheGoal) {
  const Connection virtual_uav = connection({}, false);
  CommandLine line = characterize_line();
  line.characterize->time_limit = Duration(1);
  EXPECT_EQ(characterize_command(line, virtual_uav, streams_), 1);
  EXPECT_TRUE(is_empty());
  ASSERT_TRUE(vehicle_->finished());
  EXPECT_FALSE(vehicle_->finished()->reached_goal);
}

TEST_F(Commands, WriteNoProfileWithADelayOutOfRange) {
  for (const std::string& out : {path("p.toml"), std::string()}) {
    const Connection slow = connection({.range_delays = {std::chrono::seconds(61)}}, false);
    CommandLine line = characterize_line();
    line.characterize->sensors = {"range"};
    line.characterize->out = out;
    EXPECT_EQ(characterize_command(line, slow, streams_), out.empty() ? 0 : 2);
    EXPECT_TRUE(is_empty());
    EXPECT_THAT(err(), HasSubstr("61000.0 ms"));
  }
}

TEST_F(Commands, ReportAFolderThatDoesNotExist) {
  const Connection virtual_uav = connection({}, false);
  CommandLine line = characterize_line();
  line.characterize->out = path("none/p.toml");
  EXPECT_EQ(characterize_command(line, virtual_uav, streams_), 3);
  EXPECT_FALSE(vehicle_->finished());
  line.rig = devices::Rig{"rig", {}, {}};
  EXPECT_EQ(run_command(line, streams_), 2) << "before a device is opened";
  EXPECT_THAT(err(), HasSubstr("none/p.toml"));
}

TEST_F(Commands, PrintTheRealRowBeforeTheJsonLine) {
  const Connection real = connection({.anchor_bearing_rad = 0.0, .anchor_distance_m = 9}, true);
  CommandLine line = real_row_line();
  line.real_row.true_roi = rig::PixelBox{76, 56, 8, 8};
  line.real_row.keep_image = path("i.png");
  EXPECT_EQ(real_row_command(line, real, streams_), 0);
  EXPECT_THAT(out(), AllOf(HasSubstr("i.png: image 2; "), HasSubstr("\nreal sensor    bench  "),
                           HasSubstr("\"distance_reference_m\":10.25")));
  EXPECT_EQ(err(), "");
  EXPECT_TRUE(fs::exists(path("i.png")));
  EXPECT_THAT(vehicle_->finished()->details_json, HasSubstr("angle_error_deg"));
}

TEST_F(Commands, WriteNoImageWithoutTheAnchor) {
  const Connection real = connection({.anchor_is_there = false}, true);
  CommandLine line = real_row_line();
  line.real_row.keep_image = path("i.png");
  EXPECT_EQ(real_row_command(line, real, streams_), 1);
  EXPECT_TRUE(is_empty());
  EXPECT_THAT(err(), HasSubstr("i.png"));
  EXPECT_THAT(out(), AllOf(HasSubstr("\"anchor not seen\""), Not(HasSubstr("Table II"))));
}

TEST_F(Commands, FlyPrintsTheOutcomeOrOneLineOfAnError) {
  PlanarVehicle cut({.disconnect_at = 1});
  EXPECT_EQ(fly_command(real_row_line(), cut, streams_), 3);
  EXPECT_TRUE(is_one_line(err()));
  PlanarVehicle vehicle({});
  EXPECT_EQ(fly_command(real_row_line(), vehicle, streams_), 0);
  EXPECT_THAT(out(), HasSubstr("\"goal reached\""));
}

}  // namespace
}  // namespace tether::sut
