#include "sessions/admission.h"

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

std::optional<std::string> clock_fault(const link::Hello& hello,
                                       const std::optional<computer::Clock>& wanted) {
  if (hello.concurrent && !hello.clock.allows_parallel())
    return fmt::format(
        "the clock \"{}\" does not work for several threads; start the SUT with "
        "TETHER_CLOCK='wall'",
        computer::name(hello.clock.kind));
  if (!wanted) return std::nullopt;
  const std::string given = hello.clock.text();
  const std::string asked = wanted->text();
  if (given == asked) return std::nullopt;
  std::string advice = fmt::format("start the SUT with TETHER_CLOCK='{}'", asked);
  if (hello.clock.kind == computer::ClockKind::kUnstamped)
    advice = "stamp the requests, or allow this with clock = \"unstamped\" in the condition";
  if (wanted->kind == computer::ClockKind::kUnstamped)
    advice = "Tether's client library stamps its requests; use another clock in the condition";
  return fmt::format("the SUT's clock is \"{}\", but the condition requires \"{}\"; {}", given,
                     asked, advice);
}

std::optional<std::string> build_fault(const link::Hello& hello, const GivenTime* replay) {
  const auto other = replay ? replay->other_build(hello) : std::nullopt;
  if (!other) return std::nullopt;
  return fmt::format(
      "this is not the program that was recorded: {}. An exact replay needs the same program, "
      "arguments, files and libraries; for others, use mode = \"resampled\" or \"scaled\"",
      *other);
}

}  // namespace tether::coordinator
