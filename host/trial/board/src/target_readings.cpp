#include <algorithm>
#include <charconv>
#include <cstdint>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <tether/board/target_probe.h>

/// One function per property of a machine makes its finding from the readings; evaluate() lists
/// them. run_warnings() applies some of them to the readings before and after a run.
namespace tether::board {
namespace {

using record::Readings;

// From these temperatures on, boards are about to slow down, or have.
constexpr double kWarm_C = 75.0, kHot_C = 85.0;
// Shares of one core that other programs take.
constexpr double kBusyWarn_percent = 5.0, kBusyBad_percent = 20.0;
// Share of a run; what the kernel and an idle system need is less.
constexpr double kContended = 0.1;
constexpr double kKibPerMib = 1024.0;

std::string text(const Readings& readings, const std::string& name) {
  const auto found = readings.find(name);
  return found == readings.end() ? "" : found->second;
}

std::optional<double> number(const Readings& readings, const std::string& name) {
  const std::string value = text(readings, name);
  double parsed = 0.0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), parsed);
  if (value.empty() || error != std::errc() || end != value.data() + value.size()) return {};
  return parsed;
}

Health graded(double value, double warn_from, double bad_from) {
  if (value >= bad_from) return Health::kBad;
  return value >= warn_from ? Health::kWarn : Health::kOk;
}

// ---- Voltage and heat, as reported by a Raspberry Pi

constexpr std::uint32_t kNow = 0xF, kSinceStart = 0xF0000;
constexpr const char* kThrottles[] = {"under-voltage", "frequency capped", "throttled",
                                      "soft temperature limit"};

std::uint32_t throttle_bits(const Readings& readings) {
  const std::string value = text(readings, "throttled");
  if (!value.starts_with("0x")) return 0;
  std::uint32_t bits = 0;
  std::from_chars(value.data() + 2, value.data() + value.size(), bits, 16);
  return bits;
}

/// Bits of "now" or, shifted down, of "since the start".
std::string throttle_names(std::uint32_t bits) {
  std::vector<std::string> names;
  for (std::uint32_t i = 0; i < std::size(kThrottles); ++i)
    if ((bits >> i) & 1u) names.emplace_back(kThrottles[i]);
  return fmt::format("{}", fmt::join(names, ", "));
}

std::string throttle_remedy(std::uint32_t bits) {
  const std::string power = "use a power supply and a cable that hold 5 V under load";
  const std::string heat = "cool the board";
  return (bits & 1u) ? ((bits & ~1u) ? power + ", and " + heat : power) : heat;
}

Finding check_throttled(const Readings& readings) {
  const std::uint32_t bits = throttle_bits(readings);
  const std::string value = text(readings, "throttled");
  if (bits & kNow)
    return {"throttling", fmt::format("{} now ({})", throttle_names(bits & kNow), value),
            Health::kBad, throttle_remedy(bits & kNow)};
  const std::uint32_t past = (bits & kSinceStart) >> 16;
  if (past)
    return {"throttling", fmt::format("{} since the start ({})", throttle_names(past), value),
            Health::kWarn, throttle_remedy(past) + "; it may recur under load"};
  return {"throttling", "none", Health::kOk, ""};
}

// ---- One subject each

Finding check_clock(const Readings& readings) {
  const std::string source = text(readings, "clock_source");
  if (source.empty()) return {"clock source", "cannot be read", Health::kWarn, ""};
  for (const char* slow : {"hpet", "acpi_pm", "refined-jiffies", "jiffies", "pit"})
    if (source == slow)
      return {"clock source", source,
              source.find("jiffies") == std::string::npos ? Health::kWarn : Health::kBad,
              "reading this clock is slow or coarse; to see why the kernel does not use the "
              "processor's, type: dmesg | grep -i clocksource"};
  return {"clock source", source, Health::kOk, ""};
}

double mhz(double khz) {
  return khz / 1000.0;
}

/// Neither the governor nor anything else can change the frequency.
bool has_fixed_frequency(const Readings& readings) {
  const auto least = number(readings, "frequency_min_khz"),
             most = number(readings, "frequency_max_khz");
  return least && most && *least == *most;
}

Finding check_governor(const Readings& readings) {
  const std::string governor = text(readings, "governor");
  if (governor.empty())
    return {"governor", "cannot be read", Health::kOk, "a virtual machine, or a fixed frequency"};
  if (governor == "performance" || has_fixed_frequency(readings))
    return {"governor", governor, Health::kOk, ""};
  return {
      "governor", governor, Health::kBad,
      "the frequency drops whenever the software is held; on the board, type: echo performance | "
      "sudo tee /sys/devices/system/cpu/cpu*/cpufreq/scaling_governor"};
}

/// Bad if it is below its limit although the governor should keep it there; a warning if the limit
/// is below that of the hardware.
std::optional<Finding> check_frequency(const Readings& readings) {
  const auto now = number(readings, "frequency_now_min_khz"),
             fastest = number(readings, "frequency_now_max_khz"),
             least = number(readings, "frequency_min_khz"),
             most = number(readings, "frequency_max_khz"),
             hardware = number(readings, "frequency_hardware_max_khz");
  if (!most) return std::nullopt;
  Finding finding{"frequency",
                  fmt::format("{}min {:.0f}, max {:.0f} MHz",
                              now ? fmt::format("now {:.0f}{}, ", mhz(*now),
                                                fastest && *fastest != *now
                                                    ? fmt::format(" to {:.0f}", mhz(*fastest))
                                                    : "")
                                  : "",
                              mhz(least.value_or(0.0)), mhz(*most)),
                  Health::kOk, ""};
  if (now && text(readings, "governor") == "performance" && *now < 0.9 * *most) {
    finding.health = Health::kBad;
    finding.advice = "below its limit under the governor performance, because of heat or voltage";
  } else if (hardware && *most < 0.99 * *hardware) {
    finding.health = Health::kWarn;
    finding.advice = fmt::format("limited below the {:.0f} MHz of the hardware", mhz(*hardware));
  }
  return finding;
}

std::optional<Finding> check_temperature(const Readings& readings) {
  const auto milli = number(readings, "temperature_mc");
  if (!milli) return std::nullopt;
  const double degrees = *milli / 1000.0;
  const Health health = graded(degrees, kWarm_C, kHot_C);
  return Finding{"temperature", fmt::format("{:.1f} °C", degrees), health,
                 health == Health::kOk ? "" : "boards slow down when they are hot; cool it"};
}

std::optional<Finding> check_throttle_count(const Readings& readings) {
  const auto count = number(readings, "throttle_count");
  if (!count) return std::nullopt;
  const bool never = *count == 0.0;
  return Finding{"slowed for heat",
                 never ? "never" : fmt::format("{:.0f} times since the start", *count),
                 never ? Health::kOk : Health::kWarn, never ? "" : "it may recur under load"};
}

std::optional<Finding> check_load(const Readings& readings) {
  const auto load = number(readings, "load_average");
  if (!load) return std::nullopt;
  const bool is_idle = *load < 0.5;
  return Finding{"load average", fmt::format("{:.2f} over the last minute", *load),
                 is_idle ? Health::kOk : Health::kWarn,
                 is_idle ? "" : "other programs are running; wait until it is below 0.5"};
}

/// The largest share in "name 12%, other name 7%".
int largest_percent(const std::string& busy) {
  int largest = 0;
  for (std::size_t end = busy.find('%'); end != std::string::npos; end = busy.find('%', end + 1)) {
    const std::size_t begin = busy.rfind(' ', end) + 1;
    int percent = 0;
    std::from_chars(busy.data() + begin, busy.data() + end, percent);
    largest = std::max(largest, percent);
  }
  return largest;
}

std::optional<Finding> check_busy(const Readings& readings) {
  const std::string busy = text(readings, "busy");
  if (busy.empty()) return std::nullopt;
  const int share = largest_percent(busy);
  const Health health = graded(share, kBusyWarn_percent, kBusyBad_percent);
  return Finding{"busy programs", busy, health,
                 health == Health::kOk ? "" : "their time is charged to your software; end them"};
}

std::optional<Finding> check_memory(const Readings& readings) {
  const auto total = number(readings, "memory_total_kib"),
             available = number(readings, "memory_available_kib");
  if (!total || !available) return std::nullopt;
  const bool is_enough = *available >= 0.1 * *total;
  return Finding{
      "memory",
      fmt::format("{:.0f} of {:.0f} MiB available", *available / kKibPerMib, *total / kKibPerMib),
      is_enough ? Health::kOk : Health::kWarn,
      is_enough ? "" : "too little; swapping would be charged to your software"};
}

Finding check_version(const Readings& readings, const std::string& program,
                      std::string_view version) {
  const std::string there = text(readings, "version_" + program);
  if (there.empty() || there == "none")
    return {
        program, "not in PATH", Health::kWarn,
        "needed only if your SUT's command names it; docs/guide/board.md says how to install it"};
  if (there.find(version) != std::string::npos) return {program, there, Health::kOk, ""};
  return {program, there, Health::kBad,
          fmt::format("this machine has Tether {}; install the same version there", version)};
}

Finding check_freezer(const Readings& readings) {
  if (text(readings, "freezer") == "cgroup")
    return {"freezer", "cgroup v2", Health::kOk, "used by tether-exec"};
  return {"freezer", "signals (SIGSTOP)", Health::kOk,
          "used by tether-exec: this user has no cgroup"};
}

void add(std::vector<Finding>& findings, std::optional<Finding> finding) {
  if (finding) findings.push_back(std::move(*finding));
}

}  // namespace

std::string_view name(Health health) {
  constexpr std::string_view kNames[] = {"ok", "warn", "bad"};
  return kNames[static_cast<std::size_t>(health)];
}

record::Readings parse_readings(std::string_view text) {
  record::Readings readings;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    const std::size_t equals = line.find('=');
    if (equals == std::string_view::npos || equals == 0) continue;
    std::string_view value = line.substr(equals + 1);
    while (!value.empty() && (value.back() == '\r' || value.back() == ' ')) value.remove_suffix(1);
    if (!value.empty()) readings[std::string(line.substr(0, equals))] = std::string(value);
  }
  return readings;
}

std::vector<Finding> evaluate(const Readings& readings, std::string_view version) {
  std::vector<Finding> findings;
  if (const std::string holder = text(readings, "held_by"); !holder.empty())
    findings.push_back({"in use", holder, Health::kBad, "wait for that run to end"});
  constexpr std::pair<const char*, const char*> kPlain[] = {{"system", "system"},
                                                            {"kernel", "kernel"},
                                                            {"architecture", "architecture"},
                                                            {"processor", "cpu_model"},
                                                            {"cores", "cores"}};
  for (const auto& [subject, reading] : kPlain)
    if (const std::string value = text(readings, reading); !value.empty())
      findings.push_back({subject, value, Health::kOk, ""});
  findings.push_back(check_version(readings, "tether-sut", version));
  findings.push_back(check_version(readings, "tether-exec", version));
  findings.push_back(check_freezer(readings));
  findings.push_back(check_clock(readings));
  findings.push_back(check_governor(readings));
  add(findings, check_frequency(readings));
  add(findings, check_temperature(readings));
  if (readings.contains("throttled")) findings.push_back(check_throttled(readings));
  add(findings, check_throttle_count(readings));
  add(findings, check_load(readings));
  add(findings, check_busy(readings));
  add(findings, check_memory(readings));
  return findings;
}

std::optional<double> contended_share(const Readings& before, const Readings& after) {
  constexpr double kTicksPerSecond = 100.0, kMicrosecondsPerSecond = 1e6;
  const auto growth = [&](const char* name, double per_second) -> std::optional<double> {
    const auto from = number(before, name), to = number(after, name);
    if (!from || !to) return std::nullopt;
    return (*to - *from) / per_second;
  };
  const auto run_s = growth("uptime_s", 1.0);
  const auto waited_s = growth("cpu_wait_us", kMicrosecondsPerSecond);
  const auto stolen_s = growth("cpu_stolen_ticks", kTicksPerSecond);
  if (!run_s || *run_s <= 0.0 || (!waited_s && !stolen_s)) return std::nullopt;
  return std::max(waited_s.value_or(0.0), stolen_s.value_or(0.0)) / *run_s;
}

std::vector<RunWarning> run_warnings(const Readings& before, const Readings& after, bool is_board) {
  std::vector<RunWarning> warnings;
  // At either end of the run, or for the first time since the start of the machine.
  const std::uint32_t was = throttle_bits(before), is = throttle_bits(after);
  const std::uint32_t during = ((was | is) & kNow) | (((is & ~was) & kSinceStart) >> 16);
  if (during)
    warnings.push_back({fmt::format("the target was throttled ({}; before {}, after {}): {}",
                                    throttle_names(during), text(before, "throttled"),
                                    text(after, "throttled"), throttle_remedy(during)),
                        true});
  const auto count_before = number(before, "throttle_count"),
             count_after = number(after, "throttle_count");
  if (count_before && count_after && *count_after > *count_before)
    warnings.push_back(
        {fmt::format("the target was throttled: its processor slowed down because of "
                     "heat {:.0f} times during the run",
                     *count_after - *count_before),
         true});
  if (!is_board) return warnings;
  if (const auto share = contended_share(before, after); share && *share > kContended)
    warnings.push_back({fmt::format("programs on the target waited for a processor for {:.0f} % of "
                                    "the run: others run there, or the software has more threads "
                                    "than processors",
                                    100.0 * *share),
                        false});
  if (const Finding governor = check_governor(after); governor.health == Health::kBad)
    warnings.push_back(
        {fmt::format("the target's governor is {}: {}", governor.value, governor.advice), false});
  for (const auto& finding : {check_frequency(after), check_temperature(after)})
    if (finding && finding->health == Health::kBad)
      warnings.push_back({fmt::format("the target's {} is {}: {}", finding->subject, finding->value,
                                      finding->advice),
                          false});
  return warnings;
}

}  // namespace tether::board
