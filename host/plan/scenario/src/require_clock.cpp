#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/scenario/scenario.h>

namespace tether::scenario {

void require_clock(const Scenario& scenario, const Condition& condition) {
  for (std::size_t i = 0; i < scenario.uavs.size(); ++i) {
    const UavSetup& uav = scenario.uavs[i];
    const auto& target = computer_of(condition, i).target;
    const bool is_emulated = target && (target->emulator || !target->program_folder.empty());
    if (uav.sut.is_as_is && is_emulated)
      throw Error(ErrorCode::kBadFile, scenario.where("as_is"),
                  fmt::format("the SUT of UAV \"{}\" flies as it is, which does not work in the "
                              "emulator of condition \"{}\". Use a target without one.",
                              uav.placement.name, condition.name))
          .about(uav.placement.name);
    const computer::ClockKind clock = computer_of(condition, i).clock.kind;
    if (uav.sut.is_as_is && clock == computer::ClockKind::kScripted)
      throw Error(ErrorCode::kBadFile, scenario.where("as_is"),
                  fmt::format("the SUT of UAV \"{}\" flies as it is, but condition \"{}\" has the "
                              "clock \"scripted\", which charges each call of Tether's library. "
                              "Use clock = \"cpu\" or \"wall\".",
                              uav.placement.name, condition.name))
          .about(uav.placement.name);
    const bool is_cpu_or_wall =
        clock == computer::ClockKind::kCpu || clock == computer::ClockKind::kWall;
    if (uav.sut.has_all_processes && (!is_cpu_or_wall || condition.policy == Policy::kFreeRunning))
      throw Error(ErrorCode::kBadFile, scenario.where("all_processes"),
                  fmt::format("the SUT of UAV \"{}\" flies as it is with all its processes, which "
                              "needs clock = \"cpu\" or \"wall\", and policy = "
                              "\"conservative_barrier\", but condition \"{}\" has others.",
                              uav.placement.name, condition.name))
          .about(uav.placement.name);
    if (!uav.sut.concurrent || clock == computer::ClockKind::kWall) continue;
    throw Error(
        ErrorCode::kBadFile, scenario.where("concurrent"),
        fmt::format("the SUT of UAV \"{}\" is concurrent, but condition \"{}\" has the clock "
                    "\"{}\". Several threads share a time line only with clock = \"wall\".",
                    uav.placement.name, condition.name, computer::name(clock)))
        .about(uav.placement.name);
  }
}

}  // namespace tether::scenario
