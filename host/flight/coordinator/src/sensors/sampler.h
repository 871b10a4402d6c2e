#pragma once

#include "sensors/capture_store.h"
#include "sensors/read_forecast.h"
#include "sensors/sensor_schedule.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <tether/base/time.h>
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
    bool is_drawn = false;           ///< its measurements are announced
    ReadForecast forecast{};
    std::optional<std::uint64_t> forecasted{};  ///< a measurement that is not yet announced
    std::uint64_t unqueued =
        0;  ///< measurements that its queue would have had, but for free running
  };
  /// The simulator's state at the present ST.
  using Capture = std::function<SharedState()>;
  using Announce =
      std::function<void(const sim::Snapshot&, std::size_t sensor, std::uint64_t index)>;

  Sampler(std::vector<Sensor> sensors, StepGrid grid) : sensors_(std::move(sensors)), grid_(grid) {}

  std::size_t size() const { return sensors_.size(); }
  const std::string& name(std::size_t sensor) const { return sensors_[sensor].name; }
  bool is_periodic(std::size_t sensor) const { return sensors_[sensor].schedule.is_periodic(); }

  /// The measurement for the read `call` with timestamp `t`. None if the read does not wait and no
  /// measurement is available. @pre the sensor exists, and is periodic if the read does not wait.
  std::optional<Measurement> plan(std::uint64_t call, const link::ReadSensor& read, SimTime t);
  /// What was not read by `t` counts as read. The last such measurement; none: there is none.
  /// @pre the sensor exists and is periodic
  std::optional<std::uint64_t> skip(const link::ReadSensor& read, SimTime t);
  /// Of each sensor that lacks its queue: its name, and the measurements that this has cost.
  std::vector<std::pair<std::string, std::uint64_t>> unqueued() const;
  /// When a read at `t` would get a measurement. @pre the sensor exists and is periodic.
  SimTime next_available(std::size_t sensor, SimTime t) const {
    return sensors_[sensor].schedule.choose(t, false).available_at;
  }
  /// The first boundary at which a state must be captured; SimTime::max(): none.
  SimTime next_due() const;
  /// Captures what is due by `st`. @pre no later read has a timestamp before `earliest`.
  void sample(SimTime st, SimTime earliest, const Capture& capture);

  /// A read that is planned and not yet answered.
  struct Read {
    std::uint64_t call = 0;
    std::uint32_t sensor = 0;
    Measurement measurement;
    bool on_demand = false;  ///< it has a state of its own …
    SharedState state{};     ///< … once that is captured
    bool announced = false;
  };
  /// nullptr if this call is not a read.
  const Read* find(std::uint64_t call) const;
  /// The state for the measurement. @throws Error(kInternal) if it was not captured.
  const sim::Snapshot& state_of(const Read& read) const;
  /// Removes a read that is answered at `t`.
  void answered(std::uint64_t call, SimTime t);
  /// Announces the measurements that are captured and will be read: each once when it is forecast,
  /// and once when it is planned.
  void announce(const Announce& announce);
  /// Ends sampling, because the SUT has left.
  void close();

 private:
  void sample_periodic(std::size_t sensor, SimTime st, SimTime earliest, const Capture& capture);
  std::uint64_t first_needed(std::size_t sensor, SimTime earliest) const;
  const sim::Snapshot* find_state(const Read& read) const;

  std::vector<Sensor> sensors_;
  StepGrid grid_;
  bool closed_ = false;
  std::vector<Read> reads_;  // in the order of their calls
};

}  // namespace tether::coordinator
