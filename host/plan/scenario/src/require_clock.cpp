#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/scenario/scenario.h>

namespace tether::scenario {

void require_clock(const Scenario& scenario, const Condition& condition) {
  for (std::size_t i = 0; i < scenario.uavs.size(); ++i) {
    const UavSetup& uav = scenario.uavs[i];
    const auto refuse_if = [&](bool is_refused, const char* key, const std::string& why) {
      if (!is_refused) return;
      throw Error(ErrorCode::kBadFile, scenario.where(key),
                  fmt::format("the SUT of UAV \"{}\" {}", uav.placement.name, why))
          .about(uav.placement.name);
    };
    const auto& target = computer_of(condition, i).target;
    const computer::ClockKind clock = computer_of(condition, i).clock.kind;
    refuse_if(uav.sut.is_as_is && target && (target->emulator || !target->program_folder.empty()),
              "as_is",
              fmt::format("flies as it is, which does not work in the emulator of condition "
                          "\"{}\". Use a target without one.",
                          condition.name));
    refuse_if(uav.sut.is_as_is && clock == computer::ClockKind::kScripted, "as_is",
              fmt::format("flies as it is, but condition \"{}\" has the clock \"scripted\", which "
                          "charges each call of Tether's library. Use clock = \"cpu\" or \"wall\".",
                          condition.name));
    refuse_if(uav.sut.has_all_processes &&
                  ((clock != computer::ClockKind::kCpu && clock != computer::ClockKind::kWall) ||
                   condition.policy == Policy::kFreeRunning),
              "all_processes",
              fmt::format("flies as it is with all its processes, which needs clock = \"cpu\" or "
                          "\"wall\", and policy = \"conservative_barrier\", but condition \"{}\" "
                          "has others.",
                          condition.name));
    refuse_if(uav.sut.concurrent && clock != computer::ClockKind::kWall, "concurrent",
              fmt::format("is concurrent, but condition \"{}\" has the clock \"{}\". Several "
                          "threads share a time line only with clock = \"wall\".",
                          condition.name, computer::name(clock)));
  }
}

}  // namespace tether::scenario
