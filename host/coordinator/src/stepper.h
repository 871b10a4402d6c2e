#pragma once

#include "command_queue.h"
#include "run_log.h"
#include "sampler.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <vector>

#include <tether/base/error.h>
#include <tether/record/messages.h>
#include <tether/sim/simulator.h>
#include <tether/sync/barrier_synchronizer.h>

namespace tether::coordinator {

/// The simulator threw: nothing may be asked of it any more.
struct SimulatorFailure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Drives the simulator: steps it, and at each boundary samples, applies commands and logs ground
/// truth as they are due. The caller decides how far and when to step. Errors of the simulator are
/// thrown as SimulatorFailure.
class Stepper {
 public:
  /// `samplers`: one per UAV of the simulator's world. All but these must outlive it.
  Stepper(sim::Simulator& simulator, const sync::BarrierSynchronizer& barrier, RunLog& log,
          Duration ground_truth_period, std::vector<Sampler> samplers);

  void reset(std::uint64_t seed);
  SimTime st() const { return st_; }
  const StepGrid& grid() const { return grid_; }

  /// The first boundary after the present one at which something is due.
  SimTime next_due() const;
  /// @pre st() < `to` ≤ next_due(), on the grid.
  void advance_to(SimTime to);
  /// Does what is due at the present ST, once each.
  void act();

  /// Has the command act at the first boundary not before `t`, which it returns.
  SimTime command(std::size_t uav, std::uint64_t sequence, const uav::VelocityCommand& command,
                  SimTime t);
  std::size_t waiting_commands(std::size_t uav) const { return commands_.waiting(uav); }

  Sampler& sampler(std::size_t uav) { return samplers_[uav]; }
  const Sampler& sampler(std::size_t uav) const { return samplers_[uav]; }
  /// What the read of this interaction gets, noted there; none if it reads nothing.
  std::optional<uav::Sample> measure(std::size_t uav, record::Interaction& entry);

 private:
  void sample();
  void apply_commands();
  void log_ground_truth();
  SimTime next_ground_truth() const;

  template <class F>
  auto ask(F&& f) {
    try {
      return f(*simulator_);
    } catch (const Error& e) {
      throw SimulatorFailure(e.what());
    }
  }

  sim::Simulator* simulator_;
  const sync::BarrierSynchronizer* barrier_;
  RunLog* log_;
  StepGrid grid_;
  Duration ground_truth_period_;
  std::vector<Sampler> samplers_;
  CommandQueue commands_;
  SimTime st_{};
  std::int64_t ground_truths_ = 0;  // instants logged so far
};

}  // namespace tether::coordinator
