#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/board/target_readings.h>

/// The probe's output as machines gave it.
namespace tether::board {
namespace {

using record::Readings;
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

constexpr std::string_view kHealthyPi = R"(load_average=0.08
uptime_s=912.10
memory_total_kib=3884360
memory_available_kib=3561724
clock_source=arch_sys_counter
governor=performance
frequency_now_min_khz=1800000
frequency_now_max_khz=1800000
frequency_min_khz=600000
frequency_max_khz=1800000
frequency_hardware_max_khz=1800000
temperature_mc=51121
throttled=0x0
architecture=aarch64
kernel=Linux 6.1.0-rpi7-rpi-v8
system=Debian GNU/Linux 12 (bookworm)
cpu_model=Raspberry Pi 4 Model B Rev 1.4
cores=4
online_cores=4
version_tether-sut=tether-sut 0.1.0
version_tether-exec=tether-exec 0.1.0
freezer=cgroup
busy=none
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

// A virtual machine that shows nothing of its processor.
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

Finding finding(const Readings& readings, const std::string& subject) {
  for (const Finding& finding : judge(readings, kVersion)) {
    if (finding.subject == subject) return finding;
  }
  ADD_FAILURE() << "nothing on " << subject;
  return {};
}
Finding finding(std::string_view output, const std::string& subject) {
  return finding(parse_readings(output), subject);
}

std::vector<std::string> subjects(std::string_view output, Health health) {
  std::vector<std::string> subjects;
  for (const Finding& finding : judge(parse_readings(output), kVersion))
    if (finding.health == health) subjects.push_back(finding.subject);
  return subjects;
}

/// The reading with another value; "" takes it away.
Readings with(std::string_view output, const std::string& name, const std::string& value) {
  Readings readings = parse_readings(output);
  readings.erase(name);
  if (!value.empty()) readings[name] = value;
  return readings;
}

TEST(ParseReadings, TakesLinesThatSaySomething) {
  const Readings readings = parse_readings("a=1\r\n\nno line\n=x\nb=\nc=x = y  \nd=last");
  EXPECT_EQ(readings, (Readings{{"a", "1"}, {"c", "x = y"}, {"d", "last"}}));
  EXPECT_THAT(parse_readings(""), IsEmpty());
}

TEST(Judge, FindsAllThatIsWrongWithAPi) {
  EXPECT_THAT(
      subjects(kThrottledPi, Health::kBad),
      testing::ElementsAre("tether-sut", "governor", "temperature", "throttling", "busy programs"));
  EXPECT_THAT(finding(kThrottledPi, "throttling").value,
              HasSubstr("under-voltage, throttled, soft temperature limit now (0xd000d)"));
  EXPECT_THAT(finding(kThrottledPi, "throttling").advice, HasSubstr("power supply"));
  EXPECT_THAT(finding(kThrottledPi, "throttling").advice, HasSubstr("cool"));
  EXPECT_THAT(finding(kThrottledPi, "governor").advice, HasSubstr("echo performance"));
  EXPECT_THAT(finding(kThrottledPi, "tether-sut").advice, HasSubstr("0.1.0"));
  EXPECT_EQ(finding(kThrottledPi, "temperature").value, "86.2 °C");
  EXPECT_EQ(finding(kThrottledPi, "load average").health, Health::kWarn);
}

TEST(Judge, FindsNothingWrongWithAHealthyPi) {
  EXPECT_THAT(subjects(kHealthyPi, Health::kBad), IsEmpty());
  EXPECT_THAT(subjects(kHealthyPi, Health::kWarn), IsEmpty());
  EXPECT_EQ(finding(kHealthyPi, "frequency").value, "now 1800, min 600, max 1800 MHz");
  EXPECT_EQ(finding(kHealthyPi, "freezer").value, "cgroup v2");
}

TEST(Judge, TellsAPcsGovernorAndPastHeat) {
  EXPECT_THAT(subjects(kPc, Health::kBad), testing::ElementsAre("governor"));
  EXPECT_EQ(finding(kPc, "slowed for heat").value, "12 times since the start");
  EXPECT_EQ(finding(kPc, "slowed for heat").health, Health::kWarn);
  EXPECT_EQ(finding(kPc, "busy programs").health, Health::kWarn);
  EXPECT_EQ(finding(kPc, "tether-sut").health, Health::kWarn);
  EXPECT_THAT(finding(kPc, "frequency").value, HasSubstr("now 800 to 4100"));
}

TEST(Judge, BlamesNoMachineForWhatItCannotTell) {
  EXPECT_THAT(subjects(kVm, Health::kBad), IsEmpty());
  EXPECT_THAT(subjects(kVm, Health::kWarn), IsEmpty());
  EXPECT_EQ(finding(kVm, "governor").value, "cannot be read");
  EXPECT_THAT(subjects("", Health::kBad), IsEmpty());
}

TEST(Judge, TakesAFixedFrequencyUnderAnyGovernor) {
  EXPECT_EQ(finding(with(kThrottledPi, "frequency_min_khz", "1800000"), "governor").health,
            Health::kOk);
}

TEST(Judge, FindsAFrequencyThatIsHeldBack) {
  EXPECT_EQ(finding(with(kHealthyPi, "frequency_now_min_khz", "1000000"), "frequency").health,
            Health::kBad);
  EXPECT_EQ(finding(with(kHealthyPi, "frequency_max_khz", "1500000"), "frequency").health,
            Health::kWarn);
}

TEST(Judge, TellsWhoHoldsTheBoard) {
  const auto findings = judge(with(kHealthyPi, "held_by", "ada@host since noon"), kVersion);
  EXPECT_EQ(findings.front().subject, "in use");
  EXPECT_EQ(findings.front().health, Health::kBad);
  EXPECT_THAT(findings.front().value, HasSubstr("ada@host"));
}

TEST(Judge, KnowsSlowClocks) {
  EXPECT_EQ(finding(with(kPc, "clock_source", "tsc"), "clock source").health, Health::kOk);
  EXPECT_EQ(finding(with(kPc, "clock_source", "hpet"), "clock source").health, Health::kWarn);
  EXPECT_EQ(finding(with(kPc, "clock_source", "jiffies"), "clock source").health, Health::kBad);
}

TEST(RunWarnings, AreNoneOfAHealthyBoard) {
  const Readings healthy = parse_readings(kHealthyPi);
  EXPECT_THAT(run_warnings(healthy, healthy, true), IsEmpty());
  EXPECT_THAT(run_warnings({}, {}, true), IsEmpty());
}

TEST(RunWarnings, NameAPiThatWasThrottledMeanwhile) {
  // Since the start, and not before the run; by its end all is well again.
  const auto warnings =
      run_warnings(parse_readings(kHealthyPi), with(kHealthyPi, "throttled", "0x40000"), true);
  ASSERT_THAT(warnings, SizeIs(1));
  EXPECT_TRUE(warnings[0].spoils);
  EXPECT_THAT(warnings[0].text, HasSubstr("throttled (throttled; before 0x0, after 0x40000)"));
  EXPECT_THAT(warnings[0].text, testing::Not(HasSubstr("\n")));
}

TEST(RunWarnings, DoNotBlameTheRunForWhatWasBefore) {
  const Readings before = with(kHealthyPi, "throttled", "0x50000");
  EXPECT_THAT(run_warnings(before, before, true), IsEmpty());
}

TEST(RunWarnings, CountAProcessorsOwnSlowingDown) {
  const auto warnings = run_warnings(parse_readings(kPc), with(kPc, "throttle_count", "15"), false);
  ASSERT_THAT(warnings, SizeIs(1));
  EXPECT_TRUE(warnings[0].spoils);
  EXPECT_THAT(warnings[0].text, HasSubstr("3 times"));
}

TEST(RunWarnings, LeaveTheHostItsGovernor) {
  const Readings pc = parse_readings(kPc);
  EXPECT_THAT(run_warnings(pc, pc, false), IsEmpty());
  const auto warnings = run_warnings(pc, pc, true);
  ASSERT_THAT(warnings, SizeIs(1));
  EXPECT_FALSE(warnings[0].spoils);
  EXPECT_THAT(warnings[0].text, HasSubstr("governor is powersave"));
}

TEST(Health, HasNames) {
  EXPECT_EQ(name(Health::kOk), "ok");
  EXPECT_EQ(name(Health::kWarn), "warn");
  EXPECT_EQ(name(Health::kBad), "bad");
}

}  // namespace
}  // namespace tether::board
