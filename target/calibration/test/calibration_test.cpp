#include <gmock/gmock.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/calibration/calibration.h>

namespace tether::calibration {
namespace {

using ::testing::HasSubstr;

Calibration sample() {
  Calibration calibration;
  calibration.program = "tether-sut 0.1.0";
  calibration.opencv = "4.6.0";
  calibration.when = "2031-01-01T00:00:00Z";
  calibration.machine = {"bench-pi", "a \"board\"\n", "aarch64", 4, 3, "ondemand", 1500.0, 1499.5};
  calibration.blocks = {{"prefilter", {41.25, 0.000123456}, {42.0, 43.0}},
                        {kWholeStep, {50.0, 51.0}, {52.0, 53.0}}};
  return calibration;
}

std::string error_with(const std::string& from, const std::string& to) {
  std::string text = calibration_text(sample());
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  const auto parsed = parse_calibration(text.replace(at, from.size(), to), "m.toml");
  EXPECT_FALSE(parsed) << to;
  return parsed ? "" : parsed.failure().message;
}

TEST(CalibrationFile, ReadsBackAsItWasWritten) {
  const Calibration written = sample();
  const auto read = parse_calibration(calibration_text(written), "m.toml");
  ASSERT_TRUE(read) << read.failure().message;
  EXPECT_EQ(read->program, written.program);
  EXPECT_EQ(read->opencv, written.opencv);
  EXPECT_EQ(read->when, written.when);
  EXPECT_EQ(read->machine.name, "bench-pi");
  EXPECT_EQ(read->machine.cpu, "a \"board\"\n");
  EXPECT_EQ(read->machine.cores, 4);
  EXPECT_EQ(read->machine.cpu_index, 3);
  EXPECT_EQ(read->machine.governor, "ondemand");
  EXPECT_EQ(read->machine.mhz_after, 1499.5);
  ASSERT_EQ(read->blocks.size(), 2u);
  EXPECT_EQ(read->blocks[0].name, "prefilter");
  EXPECT_EQ(read->blocks[0].cpu_ms[0], 41.25);
  EXPECT_NEAR(read->blocks[0].cpu_ms[1], 0.000123456, 1e-9);
  EXPECT_EQ(read->blocks[1].wall_ms[1], 53.0);
}

TEST(CalibrationFile, NamesWhatIsWrongAndItsLine) {
  EXPECT_THAT(error_with("workload = 1", "workload = 9"),
              HasSubstr("m.toml:2: the workload is 9, and this program's is 1"));
  EXPECT_THAT(error_with("opencv = \"4.6.0\"", ""), HasSubstr("lacks the key 'opencv'"));
  EXPECT_THAT(error_with("cores = 4", "cores = \"four\""),
              HasSubstr("'cores' of [machine] must be an integer"));
  EXPECT_THAT(error_with("41.25", "-1"),
              HasSubstr("'cpu_ms' of [block] must be numbers of greater than 0"));
  EXPECT_THAT(error_with("41.250000000", "\"fast\""), HasSubstr("but has the string \"fast\""));
  EXPECT_THAT(error_with("42.000000000, 43.000000000,", "42.0"),
              HasSubstr("differ in their number of rounds"));
  EXPECT_THAT(error_with("[machine]", "machine = = 3"), HasSubstr("m.toml:7: no valid TOML"));
}

TEST(CalibrationFile, CutAnywhereIsRefused) {
  const std::string text = calibration_text(sample());
  for (std::size_t size = 0; size + 3 < text.size(); size += 7) {
    const auto parsed = parse_calibration(text.substr(0, size), "m.toml");
    // Cut between blocks, it is whole, and lacks what a comparison needs.
    EXPECT_TRUE(!parsed || parsed->blocks.size() < 2) << size;
  }
}

TEST(CalibrationFile, ThatIsNotThereIsNamed) {
  const ScratchFolder folder;
  const auto loaded = load_calibration(folder.path("none.toml"));
  ASSERT_FALSE(loaded);
  EXPECT_THAT(loaded.failure().message, HasSubstr("none.toml: there is no such file"));
}

}  // namespace
}  // namespace tether::calibration
