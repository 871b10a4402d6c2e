#pragma once

#include "command_queue.h"
#include "run_log.h"
#include "sensors/sampler.h"
#include "sessions/computer_load.h"
#include "time/timelines.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include <tether/autopilot/flight_controller.h>
#include <tether/base/error.h>
#include <tether/radio/medium.h>
#include <tether/record/messages.h>
#include <tether/sim/simulator.h>
#include <tether/sync/least_tree.h>

namespace tether::coordinator {

/// The simulator has failed and must not be used any more.
struct SimulatorFailure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Steps the simulator, and at each boundary samples, applies commands and logs ground truth as
/// they are due. The caller decides how far and when to step. Errors of the simulator are thrown as
/// SimulatorFailure.
class Stepper {
 public:
  /// `samplers`, `losses`: one per UAV of the world. The other arguments must outlive the Stepper.
  Stepper(sim::Simulator& simulator, const Timelines& times, RunLog& log,
          Duration ground_truth_period, std::vector<Sampler> samplers,
          const std::vector<std::optional<uav::SetpointLoss>>& losses);

  void reset(std::uint64_t seed);
  SimTime st() const { return st_; }
  const StepGrid& grid() const { return grid_; }
  const sim::Simulator& simulator() const { return *simulator_; }
  const sim::World& world() const { return simulator_->world(); }

  /// The first boundary at which something is due.
  SimTime next_due() const;
  /// @pre st() < `to` ≤ next_due(), on the grid.
  void advance_to(SimTime to);
  /// Does everything that is due at the present ST, once.
  void act();

  /// Logs the contacts that began before the present ST and are not logged yet.
  void log_contacts();

  /// Queues a command; returns when it arrives, as CommandQueue does.
  SimTime command(PendingCommand command) { return commands_.push(std::move(command)); }
  /// What the UAV's computer computes, for its battery: on so much of a core in that time; or on
  /// one core, from a reply until the next request. Known before ST has passed it. Without a
  /// battery, nothing happens.
  void computes(std::size_t uav, SimTime from, SimTime to, double cores);
  void begins_computing(std::size_t uav, SimTime at);
  void ends_computing(std::size_t uav, SimTime at);
  /// When a battery was exhausted, if one was: of which UAV.
  struct Exhausted {
    std::size_t uav = 0;
    SimTime at;
  };
  std::optional<Exhausted> exhausted();

  /// What lies between two UAVs now. @throws SimulatorFailure if the simulator cannot tell walls.
  radio::Link link(std::size_t uav, std::size_t other);

  std::size_t waiting_setpoints(std::size_t uav) const { return commands_.waiting(uav); }

  const Sampler& sampler(std::size_t uav) const { return samplers_[uav]; }
  /// As those of its Sampler.
  std::optional<Measurement> plan(std::size_t uav, std::uint64_t call, const link::ReadSensor& read,
                                  SimTime t);
  std::optional<std::uint64_t> skip(std::size_t uav, const link::ReadSensor& read, SimTime t);
  void close(std::size_t uav);
  /// The sample for the read of this interaction, noted in it; none if it is not a read.
  std::optional<uav::Sample> measure(std::size_t uav, record::Interaction& entry);
  /// What the UAV's flight controller is given now. Valid as long as ST does not advance.
  autopilot::Sensed sense(std::size_t uav);
  /// The same before the flight: each measurement has noise of its own.
  autopilot::Sensed sense_at_rest(std::size_t uav);
  /// It follows this from now on.
  void fly(std::size_t uav, const uav::Setpoint& setpoint);
  bool has_battery(std::size_t uav) const { return has_battery_[uav]; }
  /// The battery now, noted in the interaction. @pre has_battery(uav)
  uav::BatterySample read_battery(std::size_t uav, record::Interaction& entry);
  /// Announces to the simulator what will be measured, so that it can draw meanwhile.
  void announce();

 private:
  autopilot::Sensed sense(std::size_t uav, const std::function<std::uint64_t()>& number);
  void note_change(std::size_t uav);
  void load_batteries(SimTime to);
  void sample();
  void apply_commands();
  void log_ground_truth();
  SimTime next_ground_truth() const;

  /// Calls the simulator, whose errors become SimulatorFailure.
  template <class F>
  auto guarded(F&& f) {
    try {
      return f(*simulator_);
    } catch (const Error& e) {
      throw SimulatorFailure(e.what());
    }
  }

  sim::Simulator* simulator_;
  const Timelines* times_;
  RunLog* log_;
  StepGrid grid_;
  Duration ground_truth_period_;
  std::vector<Sampler> samplers_;
  StatePool states_;
  sync::LeastTree due_;               // of each sampler
  std::vector<std::size_t> changed_;  // samplers that may have something to announce
  std::vector<bool> has_changed_;     // by UAV
  CommandQueue commands_;
  std::vector<bool> has_battery_;    // by UAV; all false: energy is not simulated
  std::vector<ComputerLoad> loads_;  // by UAV
  sim::Snapshot sensed_;             // for flight controllers
  SimTime st_{};
  std::int64_t ground_truths_ = 0;  // instants logged so far
};

}  // namespace tether::coordinator
