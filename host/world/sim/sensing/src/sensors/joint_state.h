#pragma once

#include "sensors/measurement.h"

#include <span>
#include <vector>

#include <tether/sim/world.h>
#include <tether/uav/samples.h>

/// The sample of the sensor of a UAV's joints. Pure.
namespace tether::sim {

/// `joints`: of the UAV; `angles_rad`: theirs.
uav::JointStateSample measure_joint_state(const JointStateModel& model,
                                          const std::vector<uav::Joint>& joints,
                                          std::span<const double> angles_rad,
                                          const MeasurementKey& key);

}  // namespace tether::sim
