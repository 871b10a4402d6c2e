#pragma once

#include "run_log.h"
#include "sessions/received.h"
#include "sessions/validator.h"

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include <tether/base/time.h>
#include <tether/link/messages.h>
#include <tether/radio/medium.h>
#include <tether/record/messages.h>
#include <tether/sync/barrier_synchronizer.h>

namespace tether::coordinator {

/// Messages between UAVs: those in transit, and what a SUT may send; and the inbox of each SUT. The
/// caller decides when the next event of the radio is handled. Not thread-safe.
class RadioTraffic {
 public:
  /// `uavs`: their names. `log` must outlive this.
  RadioTraffic(const radio::Settings& settings, std::uint64_t seed, std::vector<std::string> uavs,
               RunLog& log);

  const std::vector<std::string>& uavs() const { return uavs_; }
  std::vector<std::string> peers_of(std::size_t uav) const;

  /// What is wrong with a message of so many bytes that a SUT sends when ST is `st`.
  std::optional<Fault> spend(std::size_t uav, SimTime st, std::size_t bytes) {
    return boxes_[uav].budget.spend(st, bytes);
  }
  /// `message.to` is a name of `uavs`, or empty: all others.
  void send(std::size_t uav, std::uint64_t sequence, SimTime at, const link::SendMessage& message);

  /// A message of the flight controller has arrived, which the SUT receives in turn. False: there
  /// is no room for it, or the inbox is closed.
  bool accept(std::size_t uav, Received message);
  /// Messages of flight controllers and of the radio have rooms of their own.
  bool is_full_for_controller(std::size_t uav) const { return boxes_[uav].of_controller.is_full(); }
  /// Takes the first message that has arrived by then, for a call. In free running, it can have
  /// arrived within the step after ST.
  std::optional<Received> take_first(std::size_t uav, SimTime latest);
  /// Takes the next one if it is of the flight controller and has arrived by then.
  std::optional<Received> take_next_of_controller(std::size_t uav, SimTime latest);
  /// The call has ended: there is room for another one.
  void received(std::size_t uav, const Received& message) { --room_of(uav, message.from).taken; }
  /// Its SUT receives nothing any more.
  void close(std::size_t uav) { boxes_[uav].is_closed = true; }

  /// The next event. None: nothing is in transit.
  std::optional<sync::SutTime> next() const;
  /// Handles it: what has arrived or was lost by it. @pre next()
  std::vector<radio::Arrival> handle_next(const radio::Medium::LinkOf& link_of);
  /// Records what has become of a message; whether it is in the inbox of its receiver now.
  bool take(SimTime st, radio::Arrival arrival);
  /// What is wrong with what a SUT has sent so far; none if nothing is.
  std::optional<Fault> flood_of(std::size_t uav) const;
  /// Records what is in transit at the end of the run.
  void log_in_transit(SimTime st, const StepGrid& grid);

 private:
  static constexpr std::size_t kControllerMessages = 1024;

  struct Room {
    std::size_t most = 0;   // messages
    std::size_t taken = 0;  // by those that no call has received yet
    bool is_full() const { return taken >= most; }
  };
  struct Box {
    std::deque<Received> inbox;  // arrived, in the order of time
    Room of_radio, of_controller{.most = kControllerMessages};
    bool is_closed = false;
    RadioBudget budget;
    std::size_t full_queues = 0;  // messages without room, beyond nine for each that was sent
  };
  Room& room_of(std::size_t uav, const std::string& from) {
    return from == link::kAutopilot ? boxes_[uav].of_controller : boxes_[uav].of_radio;
  }
  void log_arrival(SimTime st, const radio::Arrival& arrival);

  std::vector<std::string> uavs_;
  radio::Medium medium_;
  std::vector<Box> boxes_;  // by UAV
  RunLog* log_;
};

}  // namespace tether::coordinator
