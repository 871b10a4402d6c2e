#include <gmock/gmock.h>

#include <tether/calibration/calibration.h>

namespace tether::calibration {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

Calibration sample() {
  Calibration calibration;
  calibration.program = "tether-sut 0.1.0";
  calibration.opencv = "4.6.0";
  calibration.when = "2031-01-01T00:00:00Z";
  calibration.machine = {"bench-pi", "a \"board\"\n", "aarch64", 4, 3, "ondemand", 1500.0, 1499.5};
  calibration.blocks = {{"prefilter", {41.25, 0.000123456}, {42.0, 43.0}},
                        {kWholeStep, {50.0, 51.0}, {52.0, 53.0}}};
  calibration.kernels = {{"stores", {1.0}, {2.0}, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10.5}}};
  return calibration;
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
  EXPECT_TRUE(read->blocks[1].work.empty());
  ASSERT_EQ(read->kernels.size(), 1u);
  EXPECT_EQ(read->kernels[0].work, written.kernels[0].work);
}

TEST(CalibrationFile, RefusalNamesLineAndKey) {
  struct Case {
    std::string from, to, line, key;
  };
  for (const Case& c :
       {Case{"workload = 1", "workload = 9", "2", "9"},
        Case{"opencv = \"4.6.0\"", "", "", "'opencv'"},
        Case{"cores = 4", "cores = \"four\"", "11", "'cores'"},
        Case{"41.25", "-1", "20", "'cpu_ms'"}, Case{"41.250000000", "\"fast\"", "20", "'cpu_ms'"},
        Case{"42.000000000, 43.000000000,", "42.0", "17", "rounds"},
        Case{"[machine]", "machine = = 3", "7", ""}}) {
    std::string text = calibration_text(sample());
    text.replace(text.find(c.from), c.from.size(), c.to);
    const auto parsed = parse_calibration(text, "m.toml");
    ASSERT_FALSE(parsed) << c.to;
    EXPECT_EQ(parsed.failure().kind, Failure::Kind::kInvalid);
    EXPECT_THAT(
        parsed.failure().message,
        AllOf(StartsWith("m.toml:" + (c.line.empty() ? "" : c.line + ":")), HasSubstr(c.key)));
  }
  EXPECT_THAT(load_calibration("/nowhere/m.toml").failure().message, StartsWith("/nowhere/m.toml"));
}

TEST(CalibrationFile, CutAnywhereIsRefused) {
  const std::string text = calibration_text(sample());
  for (std::size_t size = 0; size + 3 < text.size(); size += 7) {
    const auto parsed = parse_calibration(text.substr(0, size), "m.toml");
    // Cut between blocks, it is whole, and lacks what a comparison needs.
    EXPECT_TRUE(!parsed || parsed->blocks.size() < 2) << size;
  }
}

}  // namespace
}  // namespace tether::calibration
