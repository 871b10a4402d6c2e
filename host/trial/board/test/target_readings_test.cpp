#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/board/target_probe.h>

/// With the output of the probe on real machines.
namespace tether::board {
namespace {

using record::Readings;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr std::string_view kVersion = "0.1.0";

// A Raspberry Pi 4 with a weak power supply, in a closed box, busy with updates.
constexpr std::string_view kThrottledPi = R"(load_average=1.73
uptime_s=5231.44
memory_total_kib=3884360
memory_available_kib=3361724
clock_source=arch_sys_counter
governor=ondemand
frequency_now_min_khz=600000
frequency_now_max_khz=600000
frequency_min_khz=600000
frequency_max_khz=1800000
frequency_hardware_max_khz=1800000
temperature_mc=86212
throttled=0xd000d
architecture=aarch64
kernel=Linux 6.1.0-rpi7-rpi-v8
system=Debian GNU/Linux 12 (bookworm)
cpu_model=Raspberry Pi 4 Model B Rev 1.4
cores=4
online_cores=4
version_tether-sut=tether-sut 0.0.9
version_tether-exec=none
freezer=signals
busy=apt-get 97%, systemd-journal 6%
)";

constexpr std::string_view kPc = R"(load_average=0.31
memory_total_kib=32594044
memory_available_kib=24113456
clock_source=tsc
governor=powersave
frequency_now_min_khz=799998
frequency_now_max_khz=4100211
frequency_min_khz=800000
frequency_max_khz=4700000
frequency_hardware_max_khz=4700000
temperature_mc=58000
throttle_count=12
architecture=x86_64
kernel=Linux 6.1.0-18-amd64
cpu_model=12th Gen Intel(R) Core(TM) i7-1260P
cores=16
version_tether-sut=none
version_tether-exec=none
freezer=cgroup
busy=firefox-esr 11%
)";

// A virtual machine without readings of its processor.
constexpr std::string_view kVm = R"(load_average=0.00
memory_total_kib=8123456
memory_available_kib=7000000
clock_source=kvm-clock
architecture=x86_64
cores=2
version_tether-sut=tether-sut 0.1.0
version_tether-exec=tether-exec 0.1.0
freezer=signals
busy=none
)";

/// The readings with other values; "" removes one.
Readings with(std::string_view output, const Readings& changes) {
  Readings readings = parse_readings(output);
  for (const auto& [name, value] : changes) {
    readings.erase(name);
    if (!value.empty()) readings[name] = value;
  }
  return readings;
}

/// The same board with power, cooling and settings as they should be.
Readings healthy_pi(Readings changes = {}) {
  changes.merge(Readings{{"load_average", "0.08"},
                         {"governor", "performance"},
                         {"frequency_now_min_khz", "1800000"},
                         {"frequency_now_max_khz", "1800000"},
                         {"temperature_mc", "51121"},
                         {"throttled", "0x0"},
                         {"version_tether-sut", "tether-sut 0.1.0"},
                         {"version_tether-exec", "tether-exec 0.1.0"},
                         {"freezer", "cgroup"},
                         {"busy", "none"}});
  return with(kThrottledPi, changes);
}

Finding finding(const Readings& readings, const std::string& subject) {
  for (const Finding& finding : evaluate(readings, kVersion))
    if (finding.subject == subject) return finding;
  ADD_FAILURE() << "nothing on " << subject;
  return {};
}

std::vector<std::string> subjects(const Readings& readings, Health health) {
  std::vector<std::string> subjects;
  for (const Finding& finding : evaluate(readings, kVersion))
    if (finding.health == health) subjects.push_back(finding.subject);
  return subjects;
}

TEST(ParseReadings, IgnoresLinesWithoutAValue) {
  const Readings readings = parse_readings("a=1\r\n\nno line\n=x\nb=\nc=x = y  \nd=last");
  EXPECT_EQ(readings, (Readings{{"a", "1"}, {"c", "x = y"}, {"d", "last"}}));
  EXPECT_THAT(parse_readings(""), IsEmpty());
}

TEST(Evaluate, FindsEverythingThatIsWrongWithAPi) {
  const Readings pi = parse_readings(kThrottledPi);
  EXPECT_THAT(subjects(pi, Health::kBad),
              ElementsAre("tether-sut", "governor", "temperature", "throttling", "busy programs"));
  const Finding throttling = finding(pi, "throttling");
  EXPECT_THAT(throttling.value,
              HasSubstr("under-voltage, throttled, soft temperature limit now (0xd000d)"));
  EXPECT_THAT(throttling.advice, AllOf(HasSubstr("power supply"), HasSubstr("cool")));
  EXPECT_THAT(finding(pi, "governor").advice, HasSubstr("echo performance"));
  EXPECT_THAT(finding(pi, "tether-sut").advice, HasSubstr("0.1.0"));
  EXPECT_EQ(finding(pi, "temperature").value, "86.2 °C");
  EXPECT_EQ(finding(pi, "load average").health, Health::kWarn);
}

TEST(Evaluate, FindsNothingWrongWithAHealthyPi) {
  const Readings pi = healthy_pi();
  EXPECT_THAT(subjects(pi, Health::kBad), IsEmpty());
  EXPECT_THAT(subjects(pi, Health::kWarn), IsEmpty());
  EXPECT_EQ(finding(pi, "frequency").value, "now 1800, min 600, max 1800 MHz");
  EXPECT_EQ(finding(pi, "freezer").value, "cgroup v2");
}

TEST(Evaluate, FindsTheGovernorAndPastHeatOfAPc) {
  const Readings pc = parse_readings(kPc);
  EXPECT_THAT(subjects(pc, Health::kBad), ElementsAre("governor"));
  EXPECT_THAT(subjects(pc, Health::kWarn),
              ElementsAre("tether-sut", "tether-exec", "slowed for heat", "busy programs"));
  EXPECT_EQ(finding(pc, "slowed for heat").value, "12 times since the start");
  EXPECT_THAT(finding(pc, "frequency").value, HasSubstr("now 800 to 4100"));
}

TEST(Evaluate, MissingReadingsAreNotBad) {
  EXPECT_THAT(subjects(parse_readings(kVm), Health::kBad), IsEmpty());
  EXPECT_THAT(subjects(parse_readings(kVm), Health::kWarn), IsEmpty());
  EXPECT_THAT(subjects({}, Health::kBad), IsEmpty());
}

TEST(Evaluate, GradesSingleReadings) {
  struct Case {
    Readings readings;
    const char* subject;
    std::string_view health;
  };
  const Case cases[] = {{with(kThrottledPi, {{"frequency_min_khz", "1800000"}}), "governor", "ok"},
                        {healthy_pi({{"frequency_now_min_khz", "1000000"}}), "frequency", "bad"},
                        {healthy_pi({{"frequency_max_khz", "1500000"}}), "frequency", "warn"},
                        {healthy_pi({{"held_by", "ada@host since noon"}}), "in use", "bad"},
                        {with(kPc, {{"clock_source", "tsc"}}), "clock source", "ok"},
                        {with(kPc, {{"clock_source", "hpet"}}), "clock source", "warn"},
                        {with(kPc, {{"clock_source", "jiffies"}}), "clock source", "bad"}};
  for (const Case& c : cases)
    EXPECT_EQ(name(finding(c.readings, c.subject).health), c.health) << c.subject;
}

TEST(RunWarnings, ThereAreNoneForAHealthyBoardOrAnEarlierProblem) {
  EXPECT_THAT(run_warnings(healthy_pi(), healthy_pi(), true), IsEmpty());
  EXPECT_THAT(run_warnings({}, {}, true), IsEmpty());
  const Readings before = healthy_pi({{"throttled", "0x50000"}});
  EXPECT_THAT(run_warnings(before, before, true), IsEmpty());
}

TEST(RunWarnings, NameAProcessorThatWasThrottledDuringTheRun) {
  const auto pi = run_warnings(healthy_pi(), healthy_pi({{"throttled", "0x40000"}}), true);
  ASSERT_THAT(pi, SizeIs(1));
  EXPECT_TRUE(pi[0].spoils);
  EXPECT_THAT(pi[0].text, HasSubstr("throttled; before 0x0, after 0x40000"));
  const auto pc = run_warnings(parse_readings(kPc), with(kPc, {{"throttle_count", "15"}}), false);
  ASSERT_THAT(pc, SizeIs(1));
  EXPECT_TRUE(pc[0].spoils);
  EXPECT_THAT(pc[0].text, HasSubstr("3 times"));
}

TEST(RunWarnings, NameAProcessorThatOthersHadDuringTheRun) {
  const Readings before =
      healthy_pi({{"uptime_s", "1000.5"}, {"cpu_wait_us", "7000000"}, {"cpu_stolen_ticks", "100"}});
  const auto after = [](const char* waited_us, const char* stolen_ticks) {
    return healthy_pi(
        {{"uptime_s", "1010.50"}, {"cpu_wait_us", waited_us}, {"cpu_stolen_ticks", stolen_ticks}});
  };
  EXPECT_NEAR(contended_share(before, after("7900000", "105")).value(), 0.09, 1e-9);
  EXPECT_THAT(run_warnings(before, after("7900000", "105"), true), IsEmpty());
  EXPECT_NEAR(contended_share(before, after("7000000", "220")).value(), 0.12, 1e-9);
  const auto warnings = run_warnings(before, after("9500000", "105"), true);
  ASSERT_THAT(warnings, SizeIs(1));
  EXPECT_FALSE(warnings[0].spoils);
  EXPECT_THAT(warnings[0].text, HasSubstr("25 % of the run"));
  EXPECT_THAT(run_warnings(before, after("9500000", "105"), false), IsEmpty());
  EXPECT_FALSE(contended_share(before, before));
  EXPECT_FALSE(contended_share(healthy_pi({{"uptime_s", "1"}}), healthy_pi({{"uptime_s", "2"}})));
}

TEST(RunWarnings, IgnoreTheGovernorOfTheHost) {
  const Readings pc = parse_readings(kPc);
  EXPECT_THAT(run_warnings(pc, pc, false), IsEmpty());
  const auto warnings = run_warnings(pc, pc, true);
  ASSERT_THAT(warnings, SizeIs(1));
  EXPECT_FALSE(warnings[0].spoils);
  EXPECT_THAT(warnings[0].text, HasSubstr("powersave"));
}

}  // namespace
}  // namespace tether::board
