#pragma once

#include "run_log.h"
#include "validator.h"

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <tether/base/step_grid.h>
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

  /// A message of another kind has arrived, which the SUT receives in turn. False: the inbox is
  /// full, or closed.
  struct Received {
    std::string from;
    std::uint64_t sequence = 0;
    SimTime sent_at;
    SimTime at;
    std::shared_ptr<const std::vector<std::uint8_t>> bytes;
  };
  bool accept(std::size_t uav, Received message);
  bool is_full(std::size_t uav) const { return boxes_[uav].inbox.size() >= inbox_messages_; }
  /// Promises a message to a call, if one has arrived that no other call was promised.
  bool promise(std::size_t uav);
  /// Gives the first message to a call that was promised one.
  void receive(std::size_t uav, record::Interaction& entry, link::Reply& reply);
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
  struct Box {
    std::deque<Received> inbox;  // arrived, in the order of time
    std::size_t promised = 0;    // calls that will receive one of them
    bool is_closed = false;
    RadioBudget budget;
    std::size_t full_queues = 0;  // messages without room, beyond nine for each that was sent
  };
  void log_arrival(SimTime st, const radio::Arrival& arrival);

  std::size_t inbox_messages_;
  std::vector<std::string> uavs_;
  radio::Medium medium_;
  std::vector<Box> boxes_;  // by UAV
  RunLog* log_;
};

}  // namespace tether::coordinator
