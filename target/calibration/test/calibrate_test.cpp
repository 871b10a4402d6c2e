#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <toml++/toml.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/calibration/calibration.h>

namespace tether::calibration {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

Calibration machine(const std::string& name, double prefilter_ms, double tracking_ms) {
  Calibration calibration;
  calibration.program = "tether-sut 0.1.0";
  calibration.opencv = "4.6.0";
  calibration.when = "2031-01-01T00:00:00Z";
  calibration.machine = {name, "model of " + name, "aarch64", 4, 3, "", 0.0, 0.0};
  const auto block = [](const std::string& of, double ms) {
    return BlockTimes{of, std::vector<double>(12, ms), std::vector<double>(12, ms)};
  };
  calibration.blocks = {block("prefilter", prefilter_ms), block("tracking", tracking_ms),
                        block(kWholeStep, prefilter_ms + tracking_ms)};
  return calibration;
}

class Calibrate : public ::testing::Test {
 protected:
  Calibrate() {
    options_.measured = folder_.write("here.toml", calibration_text(machine("desk", 8.0, 2.0)));
    options_.against =
        folder_.write("there.toml", calibration_text(machine("bench pi", 40.0, 20.0)));
  }
  std::string path(const std::string& name) const { return folder_.path(name).string(); }
  std::string text() const {
    const auto made = calibrate(options_);
    EXPECT_TRUE(made) << made.failure().message;
    return made ? *made : "";
  }

  ScratchFolder folder_;
  CalibrateOptions options_;
};

TEST_F(Calibrate, ReportsFactorOfEachBlockAndErrorOfSingleFactor) {
  EXPECT_THAT(text(),
              AllOf(HasSubstr("CPU time on bench pi (model of bench pi, aarch64)\nagainst desk"),
                    HasSubstr("\nprefilter                 5.00    5.00 to 5.00\n"),
                    HasSubstr("\ngeometric mean            7.07    7.07 to 7.07\n"),
                    HasSubstr("from 5.00 (prefilter) to 10.00 (tracking). A single factor of 6.00"),
                    HasSubstr("off by up to 67 % for one of its blocks")));
}

TEST_F(Calibrate, ReportsAgreementAndEachDoubtOnceForEqualMachines) {
  Calibration doubtful = machine("desk", 8.0, 2.0);
  doubtful.machine.mhz_before = 1000.0;
  doubtful.machine.mhz_after = 2000.0;
  options_.measured = options_.against = folder_.write("same.toml", calibration_text(doubtful));
  const std::string said = text();
  EXPECT_THAT(said, AllOf(HasSubstr("Blocks agree within their intervals: a single factor of 1.00"),
                          Not(HasSubstr("disagree"))));
  const auto first = said.find("Doubtful on desk");
  ASSERT_NE(first, std::string::npos);
  EXPECT_EQ(said.find("Doubtful on desk", first + 1), std::string::npos) << said;
}

TEST_F(Calibrate, WritesTargetWithItsOrigin) {
  options_.target = path("pi.toml");
  EXPECT_THAT(text(), HasSubstr("--target " + options_.target));
  const ::toml::table target = ::toml::parse_file(options_.target);
  EXPECT_EQ(target["name"].value<std::string>(), "bench_pi");
  EXPECT_EQ(target["clock"].value<std::string>(), "cpu");
  EXPECT_EQ(target["cpu_factor"].value<double>(), 6.0) << "of the whole step";
  EXPECT_THAT(target["description"].value<std::string>().value_or(""),
              AllOf(HasSubstr("bench pi (model of bench pi, aarch64) as measured on 2031-01-01"),
                    HasSubstr("vision takes 6.00 (6.00 to 6.00) times the CPU time of desk")));
  options_.name = "mine";
  text();
  EXPECT_EQ(::toml::parse_file(options_.target)["name"].value<std::string>(), "mine");
}

TEST_F(Calibrate, RefusesUnusableFilesBeforeItMeasures) {
  options_.measured.clear();
  const auto tell = [](const std::string&) { ADD_FAILURE() << "it measures"; };
  options_.out = path("none/out.toml");
  EXPECT_THAT(calibrate(options_, tell).failure().message, StartsWith(options_.out));
  options_.out.clear();
  options_.against = path("none.toml");
  EXPECT_THAT(calibrate(options_, tell).failure().message, StartsWith(options_.against));
}

TEST_F(Calibrate, RefusesFactorThatNoTargetCanHave) {
  options_.against = folder_.write("slug.toml", calibration_text(machine("slug", 1e6, 1e6)));
  options_.target = path("slug_target.toml");
  EXPECT_EQ(calibrate(options_).failure().kind, Failure::Kind::kInvalid);
  EXPECT_FALSE(fs::exists(options_.target));
}

TEST_F(Calibrate, RefusesOptionsThatExcludeEachOther) {
  EXPECT_TRUE(check(options_));
  CalibrateOptions target_alone, name_alone;
  target_alone.target = "t.toml";
  name_alone.name = "t";
  EXPECT_THAT(check(target_alone).failure().message, HasSubstr("--against"));
  EXPECT_THAT(check(name_alone).failure().message, HasSubstr("--against"));
  options_.cpu_index = 1;
  EXPECT_THAT(check(options_).failure().message, HasSubstr("--measured"));
  CalibrateOptions counted;
  counted.program = "tether-sut";
  EXPECT_THAT(check(counted).failure().message, HasSubstr("--counted"));
  counted.counted = true;
  EXPECT_THAT(check(counted).failure().message, HasSubstr("--against"));
  counted.against = "board.toml";
  EXPECT_TRUE(check(counted));
  counted.out = "out.toml";
  EXPECT_THAT(check(counted).failure().message, HasSubstr("--out"));
}

// The least that can be measured for real: what it finds, not how long it takes.
TEST(MeasureMachine, ReportsTheMachineAndEveryBlock) {
  CalibrateOptions options;
  options.rounds = 1;
  const auto measured = measure_machine(options);
  ASSERT_TRUE(measured) << measured.failure().message;
  EXPECT_EQ(measured->blocks.size(), 6u);
  EXPECT_EQ(measured->kernels.size(), 12u);
  EXPECT_GE(measured->machine.cores, 1);
  EXPECT_GE(measured->machine.cpu_index, 0);
  EXPECT_NE(measured->machine.architecture, "");
  const auto read = parse_calibration(calibration_text(*measured), "m.toml");
  EXPECT_TRUE(read) << read.failure().message;
  options.cpu_index = 100'000;
  EXPECT_THAT(measure_machine(options).failure().message, HasSubstr("100000"));
}

}  // namespace
}  // namespace tether::calibration
