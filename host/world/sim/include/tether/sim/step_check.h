#pragma once

#include <tether/base/time.h>
#include <tether/base/warning.h>
#include <tether/sim/world.h>

/// Whether a UAV's controller works at a step of the simulation: it runs once per step, so that a
/// longer step is a longer delay in its loops.
namespace tether::sim {

/// How a small disturbance of a hovering UAV dies out.
struct HoverLoop {
  /// By which the slowest disturbance is multiplied in a step; from 1 on, the loop is not stable.
  double growth = 0.0;
  /// Damping ratio of the least damped oscillation; 1: nothing oscillates, below 0: it grows.
  double damping = 1.0;
};
/// From the poles of the closed loop: rotors, body and controller about hover, by differences of
/// `uav::Multirotor::step` itself. Pure. @pre step > 0
HoverLoop hover_loop(const uav::MultirotorParameters& airframe, double gravity_m_s2, Duration step);

/// With less, an answer to a step overshoots by more than a third.
inline constexpr double kLeastDamping = 0.3;

/// Who controls the UAVs in a simulator.
enum class Controller {
  kOurs,
  kUnknown,  ///< perhaps the simulator's own
};

/// Warns of each UAV whose loop is poorly damped at the world's step, with the longest step at
/// which it is not.
/// @throws Error(kBadFile) at the world's `step_at` if the loop of a UAV is not stable and the
/// controller is ours.
void check_step(const World& world, Controller controller, const WarningSink& warn);

}  // namespace tether::sim
