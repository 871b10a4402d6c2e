#include "admission.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <tether/link/server.h>

namespace tether::coordinator {

using link::Refusal;

std::variant<std::size_t, Refusal> admit(const link::Hello& hello, const std::string& token,
                                         const std::vector<std::string>& uavs,
                                         const std::vector<bool>& taken) {
  if (hello.protocol_version != link::kProtocolVersion)
    return Refusal{
        Refusal::Reason::kVersion,
        fmt::format("this coordinator uses link protocol {}, the SUT {}; install the same "
                    "version of Tether on both sides",
                    link::kProtocolVersion, hello.protocol_version)};
  if (!link::tokens_equal(hello.token, token))
    return Refusal{Refusal::Reason::kToken,
                   "wrong token; pass the run's TETHER_TOKEN to the SUT unchanged"};

  std::size_t uav = 0;
  if (hello.uav.empty() && uavs.size() > 1)
    return Refusal{Refusal::Reason::kUav,
                   fmt::format("the run has several UAVs ({}); select one with TETHER_UAV",
                               fmt::join(uavs, ", "))};
  if (!hello.uav.empty()) {
    const auto found = std::find(uavs.begin(), uavs.end(), hello.uav);
    if (found == uavs.end())
      return Refusal{Refusal::Reason::kUav, fmt::format("unknown UAV \"{}\"; the run has: {}",
                                                        hello.uav, fmt::join(uavs, ", "))};
    uav = static_cast<std::size_t>(found - uavs.begin());
  }
  if (taken[uav])
    return Refusal{Refusal::Reason::kUav, fmt::format("UAV \"{}\" already has a SUT", uavs[uav])};
  return uav;
}

std::string to_text(const ClockSetting& setting) {
  if (setting.kind == link::ClockKind::kCpu) return fmt::format("cpu*{}", setting.cpu_factor);
  if (setting.kind == link::ClockKind::kWall && setting.cpu_factor != 1.0)
    return fmt::format("wall*{}", setting.cpu_factor);
  if (setting.kind == link::ClockKind::kScripted)
    return fmt::format("scripted*{}", static_cast<double>(setting.computing.count()) / 1e6);
  return std::string(link::name(setting.kind));
}

ClockSetting clock_of(const link::Hello& hello) {
  return {.kind = hello.clock, .cpu_factor = hello.cpu_factor, .computing = hello.computing};
}

std::optional<std::string> clock_fault(const link::Hello& hello,
                                       const std::optional<ClockSetting>& wanted) {
  if (hello.concurrent &&
      (hello.clock == link::ClockKind::kCpu || hello.clock == link::ClockKind::kUnstamped ||
       hello.clock == link::ClockKind::kCounted || hello.clock == link::ClockKind::kReplayed))
    return fmt::format(
        "the clock \"{}\" does not work for several threads; start the SUT with "
        "TETHER_CLOCK='wall'",
        link::name(hello.clock));
  if (!wanted) return std::nullopt;
  const std::string given = to_text(clock_of(hello));
  const std::string asked = to_text(*wanted);
  if (given == asked) return std::nullopt;
  std::string advice = fmt::format("start the SUT with TETHER_CLOCK='{}'", asked);
  if (hello.clock == link::ClockKind::kUnstamped)
    advice = "stamp the requests, or allow this with clock = \"unstamped\" in the condition";
  if (wanted->kind == link::ClockKind::kUnstamped)
    advice = "Tether's client library stamps its requests; use another clock in the condition";
  return fmt::format("the SUT's clock is \"{}\", but the condition requires \"{}\"; {}", given,
                     asked, advice);
}

std::optional<std::string> build_fault(const link::Hello& hello,
                                       const std::optional<timing::Replay>& replay) {
  const auto other = replay ? replay->other_build(hello.build_id, hello.build) : std::nullopt;
  if (!other) return std::nullopt;
  return fmt::format(
      "this is not the program that was recorded: {}. An exact replay needs the same program, "
      "arguments, files and libraries; for others, use mode = \"resampled\" or \"scaled\"",
      *other);
}

}  // namespace tether::coordinator
