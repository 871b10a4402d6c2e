#include "drawing_threads.h"

#include <algorithm>

namespace tether::runner {
namespace {

bool may_distort(const TrialSpec& spec, const scenario::Computer& own) {
  if (own.clock.kind == computer::ClockKind::kUnstamped) return true;  // this machine's time
  const bool is_on_board = !spec.waits_for_sut && own.target && own.target->ssh;
  return own.clock.counts_waiting() && !is_on_board;
}

int cameras_of(const sim::World& world) {
  int cameras = 0;
  for (const sim::Uav& uav : world.uavs) {
    cameras += static_cast<int>(std::ranges::count_if(uav.sensors, [](const sim::Sensor& sensor) {
      return sensor.kind() == uav::SensorKind::kCamera;
    }));
  }
  return cameras;
}

}  // namespace

int drawing_threads(const TrialSpec& spec, const sim::World& world, int cores) {
  if (spec.condition.policy == scenario::Policy::kFreeRunning) return 0;
  for (std::size_t uav = 0; uav < spec.scenario.uavs.size(); ++uav)
    if (may_distort(spec, computer_of(spec.condition, uav))) return 0;
  return std::clamp(cores - 1, 0, cameras_of(world));
}

}  // namespace tether::runner
