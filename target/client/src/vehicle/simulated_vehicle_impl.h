#pragma once

#include "clocks/free_running_clock.h"
#include "clocks/interaction_clock.h"
#include "clocks/wall_timer.h"
#include "signals_blocked.h"
#include "vehicle/interacting_vehicle.h"
#include "vehicle/progress_reporter.h"
#include "vehicle/stage_log.h"

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <tether/client/simulated_vehicle.h>

namespace tether::client {

/// A UAV in the simulator, reached over a channel whose handshake is done. Serial: one call at a
/// time talks to the coordinator. Under the barrier, calls of two threads at the same time end the
/// run: a program that makes them is concurrent.
class SimulatedVehicle final : public InteractingVehicle {
 public:
  /// `progress_period` 0: no progress messages. In free running they are a sign of life, no more.
  SimulatedVehicle(std::unique_ptr<link::Channel> channel, link::Welcome welcome,
                   std::unique_ptr<TimeSource> source, std::unique_ptr<WallTimer> wall,
                   Duration progress_period);
  ~SimulatedVehicle() override;

  ExecTime now() const override {
    count_clock_read();
    return clock_->now();
  }
  Status sleep_for(Duration duration) override;
  Status sleep_until(ExecTime until) override;
  Status annotate(std::string_view topic, std::string_view json) override;
  Status begin_stage(std::string_view stage) override;
  Status end_stage() override;

 private:
  /// One call, from before its stamp to after the clock goes on. While it lives, the others wait.
  class Call {
   public:
    explicit Call(SimulatedVehicle& vehicle);

   private:
    std::optional<SignalsBlocked> signals_;
    std::unique_lock<std::mutex> lock_;
  };

  Result<link::Reply> interact(Body body) override;
  Duration computed_beside() const override { return source_->computed_beside(); }
  Duration computed_by_others() const override { return source_->computed_by_others(); }
  void close() override;

  /// What the calls do during their Call.
  /// @{
  Result<link::Reply> interact_alone(Body body);
  /// The SUT stops computing for that call: its timestamp.
  ExecTime begin_call(const Body& body);
  template <class Change>
  Status change_stage(Change change);
  Result<link::Reply> ask(const link::Request& request);
  Status sleep_alone(ExecTime until, bool is_relative);
  /// Ends the run if a part of the SUT's computing is not measured.
  Status complete();
  /// @}

  /// Sends a Progress unless the SUT waits for a reply. From the reporter's thread.
  bool report_progress();
  std::unique_ptr<link::Channel> channel_;
  std::unique_ptr<TimeSource> source_;
  std::unique_ptr<WallTimer> wall_;
  std::unique_ptr<InteractionClock> clock_;
  bool free_running_;  // the policy of clock_

  std::mutex calls_;  // of a Call; taken before sending_; guards what is below sending_
  std::atomic<bool> has_overlapping_calls_ = false;  // one had to wait for another one

  // A progress message is stamped and sent under this lock, and whatever else is sent takes it
  // after having held the clock: so no progress message follows a request, or is stamped later than
  // one.
  std::mutex sending_;

  std::uint64_t sequence_ = 0;
  StageLog stages_;
  std::string previous_call_ = "start";
  std::vector<link::StageTime> given_;  // of a replayed clock: the time of stages to come
  Duration previous_round_trip_{0};
  std::unique_ptr<ProgressReporter> progress_;  // last: its thread uses the others
};

}  // namespace tether::client
