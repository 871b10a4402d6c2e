#pragma once

#include "capture_store.h"
#include "sensor_schedule.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <tether/base/step_grid.h>
#include <tether/link/messages.h>
#include <tether/sim/simulator.h>

namespace tether::coordinator {

/// Decides what the sensors of one UAV sample, and when. It plans which measurement each read gets,
/// captures the simulator's state at the boundary of the sampling instant, and keeps the state
/// until the read is answered; only then are images rendered from it. Pure: the simulator is an
/// argument.
class Sampler {
 public:
  struct Sensor {
    std::string name;
    SensorSchedule schedule;
    CaptureStore captures{};         ///< of a periodic one
    std::uint64_t next_capture = 0;  ///< index of its first measurement not yet captured
  };
  using Capture = std::function<void(sim::Snapshot&)>;

  /// `tied`: by the barrier; false: free running.
  Sampler(std::vector<Sensor> sensors, StepGrid grid, bool tied)
      : sensors_(std::move(sensors)), grid_(grid), tied_(tied) {}

  std::size_t size() const { return sensors_.size(); }
  const std::string& name(std::size_t sensor) const { return sensors_[sensor].name; }
  bool is_periodic(std::size_t sensor) const { return sensors_[sensor].schedule.is_periodic(); }

  /// The measurement that the read `call` gets, whose request is stamped `t`; none if it does not
  /// wait and nothing is there. @pre the sensor is there; periodic if the read does not wait.
  std::optional<Measurement> plan(std::uint64_t call, const link::ReadSensor& read, SimTime t);
  /// The first boundary at which a state has to be captured; SimTime::max(): none.
  SimTime next_due() const;
  /// Captures what is due by `st`. No later read is stamped before `earliest`.
  void sample(SimTime st, SimTime earliest, const Capture& capture);

  /// A read that was planned and not yet answered.
  struct Read {
    std::uint64_t call = 0;
    std::uint32_t sensor = 0;
    Measurement measurement;
    bool on_demand = false;  ///< its state is captured for it alone …
    bool captured = false;   ///< … and has been, into `state`
    sim::Snapshot state{};
  };
  /// nullptr: this call reads nothing.
  const Read* find(std::uint64_t call) const;
  /// The state of which to measure. @throws Error(kInternal) if it is not there.
  const sim::Snapshot& state_of(const Read& read) const;
  /// It was answered.
  void answered(std::uint64_t call);
  /// The SUT has left: nothing is sampled any more.
  void close();

 private:
  std::optional<Measurement> choose(const SensorSchedule& schedule, const link::ReadSensor& read,
                                    SimTime t) const;
  void sample_periodic(std::size_t sensor, SimTime st, SimTime earliest, const Capture& capture);
  std::uint64_t first_needed(std::size_t sensor, SimTime earliest) const;
  sim::Snapshot take_spare();

  std::vector<Sensor> sensors_;
  StepGrid grid_;
  bool tied_;
  bool closed_ = false;
  std::vector<Read> reads_;            // in the order of their calls
  std::vector<sim::Snapshot> spares_;  // storage for the next ones
};

}  // namespace tether::coordinator
