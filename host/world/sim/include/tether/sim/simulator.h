#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <tether/base/error.h>
#include <tether/base/time.h>
#include <tether/energy/meter.h>
#include <tether/os/machine.h>
#include <tether/sim/contacts.h>
#include <tether/sim/world.h>
#include <tether/uav/multirotor.h>
#include <tether/uav/samples.h>
#include <tether/uav/setpoint.h>

namespace tether::sim {

/// What a simulator has computed since its last reset. The times, and how often the forecasts of
/// `Simulator::expect` were right, may differ between two runs with the same record.
struct SimulatorWork {
  Duration stepping{0};             ///< CPU time of steps
  Duration drawing{0};              ///< CPU time of pictures, of all threads
  std::uint64_t pictures = 0;       ///< drawn, those in vain among them
  std::uint64_t drawn_ahead = 0;    ///< of these, begun before they were asked for
  std::uint64_t drawn_in_vain = 0;  ///< of these, not asked for

  friend bool operator==(const SimulatorWork&, const SimulatorWork&) = default;
};

/// Measures the CPU time of the thread that it is used on.
class CpuTimer {
 public:
  Duration elapsed() const { return os::read_clock(CLOCK_THREAD_CPUTIME_ID) - begin_; }

 private:
  Duration begin_ = os::read_clock(CLOCK_THREAD_CPUTIME_ID);
};

/// The state of the scene at one instant, from which every sensor can be measured later. Opaque;
/// reuse one object for many captures to avoid allocation.
struct Snapshot {
  SimTime at;
  std::vector<double> state;  ///< the back end's own layout
};

/// The truth about one UAV at one instant, for the record and for scoring only.
struct GroundTruth {
  SimTime at;
  uav::BodyState body;
  std::vector<double> joints_rad{};  ///< of the UAV's joints
};

/// A simulator of UAVs, sensors and world: the host's logical process (paper, Section II).
///
/// Call order: construction through a back end's factory puts it at ST 0 of seed 0; then any number
/// of `apply`, `advance_to`, `capture`, `measure`, `ground_truth`; `reset` starts again. Sensors
/// and UAVs are addressed by their index in `world()`. One thread at a time. Every function may
/// throw Error(kSetup) if the back end is lost; after that only destruction is allowed.
///
/// Determinism: the same seed, and the same commands at the same ST, give the same bytes from
/// `measure` and `ground_truth`, independent of other measurements and of how the advance is split
/// into calls.
class Simulator {
 public:
  virtual ~Simulator() = default;
  Simulator(const Simulator&) = delete;
  Simulator& operator=(const Simulator&) = delete;

  virtual const World& world() const = 0;
  virtual StepGrid grid() const = 0;
  /// ST: always a step boundary.
  virtual SimTime now() const = 0;

  /// Back to ST 0, UAVs hovering at their start poses; `seed` keys all noise from here on.
  virtual void reset(std::uint64_t seed) = 0;

  /// Steps until `now() == t`. Allocates nothing per step. @pre t ≥ now(), t on the grid.
  virtual void advance_to(SimTime t) = 0;

  /// Whether UAVs follow any set-point; else only velocities in the heading frame.
  virtual bool takes_setpoints() const { return false; }
  /// Sets what UAV `uav` follows in every step from `now()` on, until the next call. Joints keep
  /// their angles if it has none; if it has nothing else, what is flown stays.
  /// @pre the set-point is valid for the UAV, and a velocity in the heading frame unless
  ///   takes_setpoints()
  virtual void apply(std::size_t uav, const uav::Setpoint& setpoint) = 0;

  /// Captures the state at `now()`. Cheap (a copy of the small state; no rendering).
  virtual void capture(Snapshot& snapshot) const = 0;

  /// Measures a sensor as of a snapshot of this run: renders, casts rays, adds the noise of
  /// measurement `index`. The sample's `sampled_at` is the snapshot's instant, its `index` is
  /// `index`.
  virtual uav::Sample measure(const Snapshot& snapshot, std::size_t uav, std::size_t sensor,
                              std::uint64_t index) = 0;

  /// Announces a measurement that will probably be asked for, so that a simulator can draw it on
  /// another thread before. A hint: `measure` returns the same bytes, and throws the same errors,
  /// with and without. Returns at once.
  virtual void expect(const Snapshot& /*snapshot*/, std::size_t /*uav*/, std::size_t /*sensor*/,
                      std::uint64_t /*index*/) {}
  /// None: not measured.
  virtual std::optional<SimulatorWork> work() const { return std::nullopt; }

  /// At `now()`.
  virtual GroundTruth ground_truth(std::size_t uav) const = 0;

  /// Whether UAVs move by the forces of their rotors, gravity, drag and contacts alone, so that no
  /// velocity jumps.
  virtual bool moves_by_forces() const { return false; }
  /// Whether the simulator reports contacts; if not, `take_contacts` returns nothing.
  virtual bool reports_contacts() const = 0;
  /// The contacts of UAVs that began before `now()` and were not taken yet, in the order of time.
  virtual std::vector<Contact> take_contacts() = 0;
  /// From a UAV to whatever is nearest, at `now()`. None: not measured, or there is nothing else.
  virtual std::optional<Clearance> clearance(std::size_t uav) const = 0;

  /// Walls on the straight line between two UAVs at `now()`: what rays hit of everything but UAVs.
  /// A wall is entered and left; of a surface without a back, each hit is a wall. None: not known.
  virtual std::optional<int> walls_between(std::size_t /*uav*/, std::size_t /*other*/) {
    return std::nullopt;
  }

  /// The battery at `now()`. None: the UAV has no model of energy, or it is not simulated.
  virtual std::optional<energy::Status> battery(std::size_t /*uav*/) const { return std::nullopt; }
  /// From now on, so many cores of the UAV's computer are busy (energy::Meter::computing).
  virtual void computing(std::size_t /*uav*/, double /*cores*/) {}

  /// Name and version, for the record: "MuJoCo 2.2.2, software renderer".
  virtual std::string description() const = 0;

 protected:
  Simulator() = default;
};

// Whether a UAV's controller works at a step of the simulation: it runs once per step, so that a
// longer step is a longer delay in its loops.

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
