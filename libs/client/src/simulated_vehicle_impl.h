#pragma once

#include "free_running_clock.h"
#include "interaction_clock.h"
#include "progress_reporter.h"
#include "wall_timer.h"

#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include <tether/client/simulated_vehicle.h>

namespace tether::client {

/// The text and kind of a refusal, for the caller.
Failure to_failure(const link::Refusal& refusal);

/// A UAV in the simulator, reached over a channel whose handshake is done.
class SimulatedVehicle final : public Vehicle {
 public:
  /// `progress_period` 0: no progress messages. In free running they are a sign of life, no more.
  SimulatedVehicle(std::unique_ptr<link::Channel> channel, link::Welcome welcome,
                   std::unique_ptr<TimeSource> source, std::unique_ptr<WallTimer> wall,
                   Duration progress_period);
  ~SimulatedVehicle() override;

  ExecTime now() const override { return clock_->now(); }
  const uav::Catalogue& catalogue() const override { return catalogue_; }
  Result<uav::CameraSample> read_camera(std::string_view sensor, Read read) override;
  Result<uav::ImuSample> read_imu(std::string_view sensor, Read read) override;
  Result<uav::RangeSample> read_range(std::string_view sensor, Read read) override;
  Status command_velocity(const uav::VelocityCommand& command) override;
  Status sleep_for(Duration duration) override;
  Status sleep_until(ExecTime until) override;
  Status annotate(std::string_view topic, std::string_view json) override;
  Status finish(bool reached_goal, std::string_view outcome,
                std::string_view details_json) override;

 private:
  using Body = decltype(link::Request::body);

  /// One interaction, from stamping the request to going on at the reply's timestamp.
  Result<link::Reply> interact(Body body);
  Result<link::Reply> ask(const link::Request& request);
  /// What the rules of time and the protocol demand of any reply.
  Status check(const link::Reply& reply, const link::Request& request) const;

  template <class Sample>
  Result<Sample> read(std::string_view sensor, Read read);
  Failure no_such_sensor(std::string_view sensor, uav::SensorKind kind) const;
  /// Of a camera: whether the image has the size that the catalogue promised.
  Status check(const uav::Sample& sample, const uav::SensorDescription& sensor) const;

  /// Sends a Progress unless the SUT waits for a reply. From the reporter's thread.
  bool report_progress();
  /// Remembers a failure after which there is no going on, and returns it.
  Failure give_up(Failure failure);

  std::unique_ptr<link::Channel> channel_;
  uav::Catalogue catalogue_;
  std::unique_ptr<TimeSource> source_;
  std::unique_ptr<WallTimer> wall_;
  std::unique_ptr<InteractionClock> clock_;
  FreeRunningClock* free_running_ = nullptr;  // clock_, if that is its policy

  // A progress message is stamped and sent under this lock, and whatever else is sent takes it
  // after having held the clock: so no progress message follows a request, or is stamped later than
  // one.
  std::mutex sending_;

  std::uint64_t sequence_ = 0;
  Duration previous_round_trip_{0};
  std::optional<Failure> over_;                 // why no call is possible any more
  std::unique_ptr<ProgressReporter> progress_;  // last: its thread uses the others
};

}  // namespace tether::client
