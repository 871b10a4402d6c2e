#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <tether/base/result.h>
#include <tether/base/time.h>
#include <tether/uav/catalogue.h>
#include <tether/uav/samples.h>
#include <tether/uav/setpoint.h>

namespace tether::client {

/// How to read a periodic sensor.
enum class Read {
  kNext,    ///< the newest measurement that was not yet read; waits for the next if there is none
  kLatest,  ///< the newest measurement, even if it was read before
  /// The newest measurement that was not yet read, without waiting; kNothingYet if there is none,
  /// kInvalid for a sensor that measures on demand.
  kIfAvailable,
};

/// A message of another UAV's program.
struct RadioMessage {
  std::string from;    ///< name of the UAV
  SimTime sent_at;     ///< the sender's ET at its `send`
  SimTime arrived_at;  ///< ≥ sent_at
  std::vector<std::uint8_t> bytes;
};

/// The UAV as its program sees it, simulated or real. Reads, commands, sleeps and `finish` are
/// interactions and can block. Throws nothing.
///
/// Thread-safe. Threads that use a serial vehicle take turns: under the barrier, a call during
/// another thread's call ends the run. A call of a concurrent vehicle (`is_concurrent`) waits for
/// its own reply only, while other threads continue to compute. A vehicle belongs to the process
/// that made it: after fork() the child must connect for itself.
class Vehicle {
 public:
  virtual ~Vehicle() = default;

  /// ET, the SUT's clock. Its differences are the time spent on computing and waiting.
  virtual ExecTime now() const = 0;
  virtual const uav::Catalogue& catalogue() const = 0;
  /// Whether each thread waits for its own reply only, as in programs that tether-exec started.
  virtual bool is_concurrent() const { return false; }

  /// Lets up to `depth` measurements of a periodic sensor wait, as a driver's queue does: a read
  /// gets the oldest that was not read (Read::kLatest: still the newest), and the oldest are lost
  /// when there are more; `index` of the samples shows it. The queue fills from the next read on.
  /// 1, as at first: only the newest waits. No interaction. In free running it stays 1. Fails with
  /// kInvalid if there is no such sensor, it measures on demand, the depth is not within
  /// 1..4096, or the vehicle keeps no queues.
  virtual Status set_queue(std::string_view sensor, std::uint32_t depth);
  /// How many measurements of the sensor can wait. 1 if there is no such sensor.
  virtual std::uint32_t queue_of(std::string_view) const { return 1; }

  /// What has arrived of a periodic sensor and was not read is lost. Takes no ET. Fails with
  /// kInvalid if the UAV has no such sensor, or if the vehicle is not simulated.
  virtual Status skip(std::string_view sensor);

  /// A measurement of a sensor: a sample of that kind. Fails with kInvalid if the UAV has no sensor
  /// of that kind and name.
  virtual Result<uav::Sample> read_any(std::string_view sensor, uav::SensorKind kind,
                                       Read read) = 0;
  /// The same by the type of its samples: `read<uav::ImuSample>("imu")`.
  template <class Sample>
  Result<Sample> read(std::string_view sensor, Read how = Read::kNext) {
    auto sample = read_any(sensor, uav::kind_of<Sample>(), how);
    if (!sample) return sample.failure();
    return std::get<Sample>(std::move(*sample));
  }

  /// The battery now; a program can tell from its catalogue whether it has one. Fails with kInvalid
  /// if not.
  virtual Result<uav::BatterySample> read_battery();

  /// Flies with this velocity until the next command.
  virtual Status command_velocity(const uav::VelocityCommand& command) = 0;
  /// Follows a trajectory: each set-point from its time, counted from when the command takes
  /// effect, until that of the next one; the last one until the next command. A command ends the
  /// trajectory before it. Fails with kInvalid for what uav::complaint_about names, with the limits
  /// of the catalogue.
  virtual Status follow(std::span<const uav::TimedSetpoint> trajectory);
  /// Follows this set-point until the next command.
  Status command(const uav::Setpoint& setpoint);

  /// Waits in simulation; with a concurrent vehicle only the calling thread waits. A duration or
  /// instant in the past returns at once (and is still an interaction).
  virtual Status sleep_for(Duration duration) = 0;
  virtual Status sleep_until(ExecTime until) = 0;

  /// The other UAVs of the run, to which messages can be sent.
  virtual const std::vector<std::string>& peers() const;
  /// Sends a message by radio, to the UAV of that name, or to all others if `to` is empty. Returns
  /// at the same ET; whether and when the message arrives is up to the radio. Fails with kInvalid
  /// if there is no such UAV or no other one, for more than 65,536 bytes, and if the vehicle has no
  /// radio.
  virtual Status send(std::string_view to, std::span<const std::uint8_t> bytes);
  /// The next message that has arrived; waits for one until `timeout` has passed. Messages are
  /// received in the order of their arrival; those that arrive at one instant in the order of UAVs
  /// in the scenario, and of one UAV in the order in which it sent them. kNothingYet if none has
  /// arrived by the timeout.
  virtual Result<RadioMessage> receive(Duration timeout);
  /// The same, but it also ends, with nothing, when one of these periodic sensors has a measurement
  /// that was not read: at once, if there is one already. After a message of the flight controller,
  /// the next ones that have arrived, at most `most` in all. Fails as well with kInvalid if one is
  /// no periodic sensor of the UAV, or if the vehicle is not simulated.
  virtual Result<std::vector<RadioMessage>> receive_or_measure(
      Duration timeout, std::span<const std::string_view> sensors, std::uint32_t most);

  /// Writes a message into the record, without waiting for the coordinator. With a serial vehicle
  /// it takes no ET, but can wait for another thread's call. `json` is one JSON object.
  virtual Status annotate(std::string_view topic, std::string_view json) = 0;

  /// What is computed from here on belongs to the stage of that name, until the matching
  /// end_stage(); of nested stages the innermost one counts. For the record: takes no ET, and is no
  /// interaction. With a concurrent vehicle, each thread has its own stages. Real vehicles ignore
  /// it. Fails with kInvalid if the name is empty, longer than 256 bytes or has control characters,
  /// or if there are more than 254 stages between two calls.
  virtual Status begin_stage(std::string_view) { return ok_status(); }
  /// Fails with kInvalid if no stage is open.
  virtual Status end_stage() { return ok_status(); }

  /// Ends the mission. Every later call fails with kInvalid; open calls of other threads of a
  /// concurrent vehicle fail with kRunEnded.
  virtual Status finish(bool reached_goal, std::string_view outcome,
                        std::string_view details_json) = 0;
};

/// All measurements that wait in the sensor's queue, in order: at least one, for which it waits,
/// and at most as many as the queue has room for. Does not depend on their stamps.
template <class Sample>
Result<std::vector<Sample>> read_all(Vehicle& vehicle, std::string_view sensor) {
  std::vector<Sample> samples;
  auto sample = vehicle.read<Sample>(sensor);
  while (sample) {
    samples.push_back(std::move(*sample));
    if (samples.size() >= vehicle.queue_of(sensor)) return samples;
    sample = vehicle.read<Sample>(sensor, Read::kIfAvailable);
  }
  if (sample.failure().kind != Failure::Kind::kNothingYet) return sample.failure();
  return samples;
}

/// How far the stamps of measurements of one instant can be apart: 0, or half of the shortest
/// period if the driver of one of the sensors stamps by a clock of its own.
Duration most_apart(const uav::Catalogue& catalogue, const std::vector<std::string_view>& sensors);

/// kInvalid if a sensor is named twice: a measurement is read once.
Status each_once(const std::vector<std::string_view>& sensors);

/// One measurement of each sensor, all of one instant: for a stereo pair, or colour and depth.
/// Reads those that are behind until all stamps are within `most_apart`: equal, or as a driver's
/// synchroniser pairs them. Needs a queue of a few measurements (`set_queue`), so that what one
/// sensor delivers earlier is not lost. Fails with kInvalid as `each_once`, and if after 50
/// reads of each there was no common instant.
template <class Sample>
Result<std::vector<Sample>> read_together(Vehicle& vehicle,
                                          const std::vector<std::string_view>& sensors) {
  const std::size_t most_reads = 50 * sensors.size();
  if (const Status once = each_once(sensors); !once) return once.failure();
  const Duration apart = most_apart(vehicle.catalogue(), sensors);
  std::vector<Sample> samples(sensors.size());
  std::vector<SimTime> stamps(sensors.size(), SimTime::min());  // which is: not read
  for (std::size_t reads = 0; reads < most_reads; ++reads) {
    const auto [earliest, latest] = std::ranges::minmax_element(stamps);
    if (*earliest != SimTime::min() && *latest - *earliest <= apart) return samples;
    const auto behind = static_cast<std::size_t>(earliest - stamps.begin());
    auto sample = vehicle.read<Sample>(sensors[behind]);
    if (!sample) return sample.failure();
    samples[behind] = std::move(*sample);
    stamps[behind] = samples[behind].sampled_at;
  }
  return Failure{Failure::Kind::kInvalid,
                 "the sensors have no measurements of one instant: give them one rate and phase"};
}

/// A stage for as long as the object lives (Vehicle::begin_stage).
class Stage {
 public:
  Stage(Vehicle& vehicle, std::string_view name)
      : vehicle_(vehicle.begin_stage(name) ? &vehicle : nullptr) {}
  ~Stage() {
    if (vehicle_ != nullptr) static_cast<void>(vehicle_->end_stage());
  }
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

 private:
  Vehicle* vehicle_;
};

/// Measurements that are delivered to a callback. A thread of the library reads the sensor
/// continuously (Read::kNext) and calls the program with each measurement, at the ET at which it is
/// available.
///
/// If measurements arrive while the callback runs, it receives the newest of them afterwards.
/// Measurements that other threads read from the same sensor are not delivered: kNext returns each
/// measurement once for each SUT.
///
/// Destruction cancels an open read and waits for a running callback. A callback can destroy its
/// own subscription. Thread-safe.
class Subscription {
 public:
  virtual ~Subscription() = default;
  Subscription(const Subscription&) = delete;
  Subscription& operator=(const Subscription&) = delete;

  /// Why no more measurements will arrive, for example kRunEnded; none while they arrive.
  virtual std::optional<Failure> ended() const = 0;

 protected:
  Subscription() = default;
};

/// Subscribes to a periodic sensor. `vehicle` must outlive the subscription. The callback runs in a
/// thread of the subscription with every signal blocked; it can call the vehicle, and must not
/// throw.
///
/// Fails with kInvalid if the vehicle is not concurrent (the program was not started with
/// tether-exec), the UAV has no such sensor, or it measures on demand.
/// @{
Result<std::unique_ptr<Subscription>> subscribe_any(
    Vehicle& vehicle, std::string_view sensor, uav::SensorKind kind,
    std::function<void(const uav::Sample&)> on_measurement);
/// `subscribe<uav::ImuSample>(vehicle, "imu", [](const uav::ImuSample& sample) { … })`
template <class Sample, class Callback>
Result<std::unique_ptr<Subscription>> subscribe(Vehicle& vehicle, std::string_view sensor,
                                                Callback on_measurement) {
  return subscribe_any(vehicle, sensor, uav::kind_of<Sample>(),
                       [on_measurement = std::move(on_measurement)](const uav::Sample& sample) {
                         on_measurement(std::get<Sample>(sample));
                       });
}
/// @}

}  // namespace tether::client
