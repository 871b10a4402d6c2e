#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <unistd.h>

#include <tether/client/vehicle.h>
#include <tether/link/messages.h>

namespace tether::client {

/// The text and kind of a refusal, for the caller.
Failure to_failure(const link::Refusal& refusal);
Failure protocol_failure(const std::string& what);
/// What calls after the end of the mission come to.
Failure mission_finished();
/// What the protocol demands of the reply to a request and, unless ET is only told
/// (`free_running`), the rules of time.
Status check(const link::Reply& reply, const link::Request& request,
             const uav::Catalogue& catalogue, bool free_running);
/// `et + duration` within what a message may carry.
ExecTime add_within_bounds(ExecTime et, Duration duration);
/// The Sleep until then, or until the first or last instant that a message may carry.
link::Sleep make_sleep(ExecTime until);

/// How stages between calls name a call (link::stage_between).
std::string name_of_call(const decltype(link::Request::body)& body,
                         const uav::Catalogue& catalogue);

/// What vehicles in the simulator have in common: calls become requests, replies results.
/// Thread-safe as far as `interact` is.
class InteractingVehicle : public Vehicle {
 public:
  const uav::Catalogue& catalogue() const final { return catalogue_; }
  Status set_queue(std::string_view sensor, std::uint32_t depth) final;
  std::uint32_t queue_of(std::string_view sensor) const final;
  Status skip(std::string_view sensor) final;
  Result<uav::Sample> read_any(std::string_view sensor, uav::SensorKind kind, Read read) final;
  Result<uav::BatterySample> read_battery() final;
  Status command_velocity(const uav::VelocityCommand& command) final;
  Status follow(std::span<const uav::TimedSetpoint> trajectory) final;
  const std::vector<std::string>& peers() const final { return peers_; }
  Status send(std::string_view to, std::span<const std::uint8_t> bytes) final;
  Result<RadioMessage> receive(Duration timeout) final;
  Result<std::vector<RadioMessage>> receive_or_measure(Duration timeout,
                                                       std::span<const std::string_view> sensors,
                                                       std::uint32_t most) final;
  Status finish(bool reached_goal, std::string_view outcome, std::string_view details_json) final;

  using Body = decltype(link::Request::body);
  Result<link::Reply> pass_on(Body body) { return interact(std::move(body)); }

 protected:
  InteractingVehicle(uav::Catalogue catalogue, std::vector<std::string> peers)
      : catalogue_(std::move(catalogue)),
        peers_(std::move(peers)),
        queues_(catalogue_.sensors.size()) {
    for (auto& queue : queues_) queue = 1;
  }

  /// One interaction, from stamping the request to going on after its reply. After one that
  /// finishes the mission, `over` is set.
  virtual Result<link::Reply> interact(Body body) = 0;
  /// As TimeSource has it.
  virtual Duration computed_beside() const { return Duration::zero(); }
  virtual Duration computed_by_others() const { return Duration::zero(); }
  /// Each call of now() counts: a program that waits in a loop makes very many.
  void count_clock_read() const { clock_reads_.fetch_add(1, std::memory_order_relaxed); }
  /// The mission is finished: lets go of the coordinator.
  virtual void close() = 0;

  /// Remembers a failure after which there is no going on (the first one stays) and returns it.
  Failure give_up(Failure failure);
  /// False: in a child that was forked.
  bool is_of_this_process() const { return ::getpid() == process_; }
  /// Fails in a process other than the one that made this (a child that was forked has this one's
  /// connections, and both would speak on them), and after the end. To be asked before any lock is
  /// taken: in the child a thread that does not exist there may hold it.
  Status usable() const;

 private:
  /// What is to be known at the end (uav::kClientReport), as JSON; empty: nothing.
  std::string report() const;
  /// Counts commands that were invalid. @return `status`
  Status commanded(Status status);
  Result<uav::Sample> take_sample(link::Reply reply, const uav::SensorDescription& sensor,
                                  Read read);
  Failure no_such_sensor(std::string_view sensor, uav::SensorKind kind) const;
  Result<std::uint32_t> find_periodic(std::string_view sensor) const;

  uav::Catalogue catalogue_;
  std::vector<std::string> peers_;
  std::vector<std::atomic<std::uint32_t>> queues_;  // of each sensor
  std::atomic<std::uint64_t> refused_commands_ = 0;
  mutable std::atomic<std::uint64_t> clock_reads_ = 0;
  pid_t process_ = ::getpid();
  mutable std::mutex mutex_;
  std::optional<Failure> over_;  // guarded by mutex_
};

/// Of an interaction whose reply carries nothing.
inline Status status_of(const Result<link::Reply>& reply) {
  return reply ? ok_status() : Status(reply.failure());
}

}  // namespace tether::client
