#include "drawing_threads.h"

#include <algorithm>

namespace tether::runner {
namespace {

bool may_distort(const TrialSpec& spec) {
  switch (spec.condition.clock) {
    case scenario::Clock::kWall:
      return spec.sut_place() != SutPlace::kBoard;
    case scenario::Clock::kUnstamped:  // this machine's time
      return true;
    case scenario::Clock::kCpu:
    case scenario::Clock::kCounted:
    case scenario::Clock::kReplayed:
    case scenario::Clock::kScripted:
      return false;
  }
  return true;
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
  if (spec.condition.policy == scenario::Policy::kFreeRunning || may_distort(spec)) return 0;
  return std::clamp(cores - 1, 0, cameras_of(world));
}

}  // namespace tether::runner
