#include "commands/program_scenario.h"

#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/autopilot/external.h>
#include <tether/base_testing/scratch_folder.h>
#include <tether/base_testing/thrown_error.h>
#include <tether/os/child_process.h>
#include <tether/os/text_file.h>
#include <tether/runner/trial_folder.h>
#include <tether/scenario/scenario.h>

namespace tether::app {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

class ProgramScenarioTest : public testing::Test {
 protected:
  ProgramScenarioTest() { options_.command = {"python3", "fly.py"}; }

  ProgramScenario made(const std::string& profile = "") const {
    return make_program_scenario(options_, profile, shipped_);
  }
  /// As the reader of all scenarios sees it.
  scenario::Scenario read(const std::string& profile = "") const {
    return scenario::load_scenario(scratch_.write("scenario.toml", made(profile).text));
  }

  ProgramOptions options_;
  scenario::ShippedFiles shipped_ = scenario::ShippedFiles::of_program(os::own_file());
  ScratchFolder scratch_;
};

TEST_F(ProgramScenarioTest, FliesAProgramAsItIsByDefault) {
  const scenario::Scenario scenario = read();
  const scenario::UavSetup& uav = scenario.uavs.at(0);
  EXPECT_EQ(scenario.name, "python3");
  EXPECT_EQ(scenario.world.filename(), "yard.sdf");
  EXPECT_THAT(scenario.anchors, ElementsAre());
  EXPECT_THAT(uav.sut.command, ElementsAre("python3", "fly.py"));
  EXPECT_TRUE(uav.sut.is_as_is);
  ASSERT_TRUE(uav.flight_controller);
  EXPECT_EQ(uav.flight_controller->external, nullptr);
  EXPECT_FALSE(uav.flight_controller->starts_in_air);
  EXPECT_EQ(uav.profile->name, "paper_streaming");
  ASSERT_EQ(scenario.conditions.size(), 2U);
  EXPECT_EQ(scenario.conditions[0].name, "host");
  EXPECT_EQ(scenario.conditions[1].name, "target");
  EXPECT_EQ(scenario.conditions[1].computers[0].clock.factor, 6.0);
  EXPECT_EQ(scenario.metrics.at(0).max, 120.0);
  EXPECT_EQ(scenario.time_limit, std::chrono::seconds(121));  // or no flight could miss it
}

TEST_F(ProgramScenarioTest, HasWhatTheOptionsSay) {
  options_.world = "room";
  options_.model = fs::relative(shipped_.models() / "hummingbird_lidar/model.sdf").string();
  options_.position_m = {1.0, -2.0, 1.5};
  options_.flight_controller = "built-in";
  options_.starts_in_air = true;
  options_.time_limit_s = 7.5;
  options_.cpu_factor = 2.5;
  options_.anchors = {"blue_box"};
  const scenario::Scenario scenario = read("ideal");
  const scenario::UavSetup& uav = scenario.uavs.at(0);
  EXPECT_EQ(scenario.world.filename(), "room.sdf");
  EXPECT_EQ(uav.placement.model.parent_path().filename(), "hummingbird_lidar");
  EXPECT_EQ(uav.placement.p_WB, (uav::Vec3{1.0, -2.0, 1.5}));
  EXPECT_TRUE(uav.flight_controller->starts_in_air);
  EXPECT_EQ(uav.profile->name, "ideal");
  EXPECT_EQ(scenario.metrics.at(0).max, 7.5);
  EXPECT_EQ(scenario.conditions[1].computers[0].clock.factor, 2.5);
  EXPECT_THAT(scenario.anchors, ElementsAre("blue_box"));
}

TEST_F(ProgramScenarioTest, HasPx4OrNoFlightController) {
  options_.flight_controller = "px4";
  options_.controller_path = "build/px4";
  const auto px4 = read().uavs.at(0).flight_controller;
  ASSERT_TRUE(px4);
  ASSERT_NE(px4->external, nullptr);
  EXPECT_EQ(px4->external->key, "px4");
  EXPECT_EQ(px4->path, fs::absolute("build/px4"));
  options_.controller_path.reset();
  options_.flight_controller = "none";
  EXPECT_FALSE(read().uavs.at(0).flight_controller);
}

TEST_F(ProgramScenarioTest, AProgramWithTethersLibraryCommandsTheUavItself) {
  options_.uses_library = true;
  EXPECT_FALSE(read().uavs.at(0).sut.is_as_is);
  EXPECT_FALSE(read().uavs.at(0).flight_controller);
  options_.starts_in_air = true;
  EXPECT_EQ(thrown_error(ErrorCode::kUsage, [&] { made(); }).subject(), "--starts-in-air");
}

TEST_F(ProgramScenarioTest, AllItsProcessesFlyUnlessOneIsWanted) {
  EXPECT_TRUE(read().uavs.at(0).sut.has_all_processes);
  options_.has_one_process = true;
  EXPECT_FALSE(read().uavs.at(0).sut.has_all_processes);
  options_.uses_library = true;
  EXPECT_EQ(thrown_error(ErrorCode::kUsage, [&] { made(); }).subject(), "--one-process");
  options_.has_one_process = false;
  EXPECT_FALSE(read().uavs.at(0).sut.has_all_processes);
}

TEST_F(ProgramScenarioTest, KeepsEachCharacterOfTheArguments) {
  options_.command = {"sh", "-c", "a \"b\" \\ 'c'\n\t#{world} = {world}", "ü", "--", "-x"};
  EXPECT_EQ(read().uavs.at(0).sut.command, options_.command);
  options_.command = {"sh", "\xff"};
  EXPECT_THAT(thrown_error(ErrorCode::kUsage, [&] { made(); }).what(), HasSubstr("UTF-8"));
}

TEST_F(ProgramScenarioTest, IsNamedAfterTheScriptOrTheProgram) {
  const std::string script = scratch_.write("my flight.py", "");
  const std::pair<std::vector<std::string>, std::string> cases[] = {
      {{"python3", script, "--fast"}, "my_flight"},
      {{"/usr/bin/python3.11", "-u", script}, "my_flight"},
      {{script, "plan.txt"}, "my_flight"},
      {{"companion", script}, "companion"},
      {{"python3", "-m", "package.module"}, "python3"},
      {{"/nowhere/companion.bin"}, "companion"},
      {{"./.hidden"}, "program.hidden"},
      {{std::string(100, 'a')}, std::string(64, 'a')}};
  for (const auto& [command, name] : cases) {
    options_.command = command;
    EXPECT_EQ(made().name, name);
    EXPECT_EQ(read().name, name);
  }
}

// The user never wrote a line of the file.
TEST_F(ProgramScenarioTest, ErrorsOfTheReaderNameTheOption) {
  const std::pair<std::function<void(ProgramOptions&)>, std::string> cases[] = {
      {[](auto& o) { o.world = "nowhere.sdf"; }, "--world nowhere.sdf: "},
      {[](auto& o) { o.model = "nowhere.sdf"; }, "--model nowhere.sdf: "},
      {[](auto& o) {
         o.position_m = {0.0, 0.0, 1e30};
       },
       "--position [0, 0, 1e+30]: "},
      {[](auto& o) {
         o.flight_controller = "px4", o.controller_path = "x", o.starts_in_air = true;
       },
       "--starts-in-air: "},
      {[](auto& o) { o.time_limit_s = -3.0; }, "--time-limit -3: "},
      {[](auto& o) {
         o.anchors = {"a", "a"};
       },
       "--anchor a: "},
      {[](auto& o) { o.cpu_factor = 1e9; }, "--cpu-factor 1000000000: "}};
  for (const auto& [change, begin] : cases) {
    options_ = {};
    options_.command = {"ls"};
    change(options_);
    const Error own = thrown_error(ErrorCode::kBadFile, [&] { read(); });
    const Error told = about_option(own, scratch_.path("scenario.toml"), made());
    EXPECT_EQ(told.code(), ErrorCode::kUsage);
    EXPECT_THAT(told.what(), testing::StartsWith(begin));
    EXPECT_THAT(told.what(), testing::Not(HasSubstr("scenario.toml")));
  }
  const Error other(ErrorCode::kBadFile, {"other.toml", 3}, "is wrong");
  EXPECT_STREQ(about_option(other, scratch_.path("scenario.toml"), made()).what(), other.what());
}

TEST_F(ProgramScenarioTest, AControllerOfYourOwnNeedsItsBuild) {
  options_.flight_controller = "px4";
  EXPECT_THAT(thrown_error(ErrorCode::kUsage, [&] { made(); }).what(),
              HasSubstr("--controller-path FOLDER"));
}

TEST_F(ProgramScenarioTest, NamesThatAreNotShippedAreRefusedBeforeAnythingIsRead) {
  options_.world = "yrad";
  const Error error = thrown_error(ErrorCode::kUsage, [&] { made(); });
  EXPECT_EQ(error.subject(), "--world");
  EXPECT_THAT(error.what(), HasSubstr("did you mean 'yard'"));
}

/// Gives an option some value.
struct Give {
  void operator()(bool* to) const { *to = true; }
  void operator()(std::vector<std::string>* to) const { *to = {"x"}; }
  void operator()(std::optional<std::string>* to) const { *to = "x"; }
  void operator()(std::optional<double>* to) const { *to = 1.0; }
  void operator()(std::optional<std::vector<double>>* to) const { *to = {1.0}; }
  void operator()(auto&&) const { FAIL() << "no option of a program has this type"; }
};

TEST(ProgramOptions, AreRefusedWithoutAProgram) {
  EXPECT_NO_THROW(require_no_program_options({}));
  ProgramOptions options;
  for (const Option& row : program_rows(options)) {
    if (row.allowed.follows_dashes) continue;
    options = {};
    std::visit(Give{}, row.destination);
    const Error error =
        thrown_error(ErrorCode::kUsage, [&] { require_no_program_options(options); });
    EXPECT_EQ(error.subject(), key_of(row));
  }
}

TEST_F(ProgramScenarioTest, ItsFileStaysOnlyIfItFlew) {
  const fs::path folder = scratch_.path("out/fly");
  { const ProgramScenarioFile file(folder, made()); }
  EXPECT_FALSE(fs::exists(scratch_.path("out")));
  {
    ProgramScenarioFile file(folder, made());
    EXPECT_EQ(os::read_file(file.path()), made().text);
    file.keep();
  }
  options_.world = "room";
  { const ProgramScenarioFile file(folder, made()); }
  EXPECT_EQ(os::read_file(folder / runner::kMadeScenarioFile), made().text);
}

TEST_F(ProgramScenarioTest, AFileOfTheUserIsNotReplaced) {
  for (const std::string& text :
       {std::string("name = \"mine\"\n"), made().text.substr(made().text.find("name"))}) {
    const std::string file = scratch_.write("scenario.toml", text);
    const Error error = thrown_error(
        ErrorCode::kUsage, [&] { const ProgramScenarioFile made_file(scratch_.path(), made()); });
    EXPECT_THAT(error.what(), HasSubstr("tether run " + file));
    EXPECT_EQ(os::read_file(file), text);
  }
}

}  // namespace
}  // namespace tether::app
