#pragma once

#include "time/free_time.h"
#include "time/shared_time.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <tether/coordinator/coordinator.h>

namespace tether::coordinator {

/// The time of all SUTs of a run: which reply is sent next, and how far ST may advance. The rules
/// of DESIGN section 2 are in `sync`; here they meet what each SUT is.
class Timelines {
 public:
  /// @throws Error(kInternal) if the boards or the pace of the options are not as documented.
  Timelines(const RunOptions& options, StepGrid grid);
  Timelines(const Timelines&) = delete;
  Timelines& operator=(const Timelines&) = delete;

  /// Why a SUT that wants to join cannot have its time here; none if it can.
  std::optional<std::string> fault_of(std::size_t uav, const link::Hello& hello) const;
  /// Every SUT has joined, and computes from now on: chooses how the time of the next one is known.
  /// `cores`: of its machine; 0: not known. @pre in the order of UAVs
  void begin(std::size_t uav, const link::Hello& hello, int cores, WallTime now);

  Timeline& operator[](std::size_t uav) { return *timelines_[uav]; }
  const Timeline& operator[](std::size_t uav) const { return *timelines_[uav]; }
  /// Whether every run with these SUTs has the same messages: no clock has a part in them.
  bool repeats() const;

  /// ST must not advance beyond it, until a SUT sends something or a reply is sent.
  SimTime limit() const {
    return free_calls_.empty() ? barrier_.lower_bound() : free_calls_.begin()->due;
  }
  /// As those of sync::BarrierSynchronizer; in free running, whatever does not wait is released,
  /// and nothing is known of later messages.
  /// @{
  std::optional<sync::SutTime> earliest() const { return barrier_.earliest(); }
  std::optional<sync::TimeAdvanceGrant> release(SimTime st,
                                                const std::optional<sync::SutTime>& message);
  /// @}
  /// Some WT has passed.
  void read_timers(WallTime now);

  /// Gives `handle` the messages on modelled boards whose instant is known now, and raises bounds.
  /// Whether anything has changed: then another pool may go on, or a message arrive.
  /// `next_message`: as for `release`. `used`: what the SUTs compute on the way.
  bool settle(const std::function<std::optional<sync::SutTime>()>& next_message,
              const Pool::Used& used, const std::function<void(Sent)>& handle);

 private:
  void divide(const RunOptions& options, std::size_t board);
  void add_pool(const RunOptions& options, const std::vector<std::size_t>& uavs, int cores);
  ExecTime undisturbed_until(const Pool& pool, const std::optional<sync::SutTime>& message) const;

  sync::SyncPolicy policy_;
  StepGrid grid_;
  Duration least_delay_;  // of a message by radio
  sync::BarrierSynchronizer barrier_;
  std::set<FreeCall> free_calls_;
  std::vector<Pool> pools_;
  std::vector<std::optional<std::size_t>> pool_of_;  // by UAV
  std::vector<bool> is_in_group_;  // by UAV: it is stopped with the others of its real board
  std::vector<std::unique_ptr<Timeline>> timelines_;  // by UAV
  std::vector<Timeline*> timed_;                      // by the coordinator
};

}  // namespace tether::coordinator
