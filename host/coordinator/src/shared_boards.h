#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <optional>
#include <variant>
#include <vector>

#include <tether/coordinator/coordinator.h>
#include <tether/link/messages.h>
#include <tether/sync/shared_cores.h>

namespace tether::coordinator {

/// What a SUT sent, with the stamp of its own work, and the ST and WT of its arrival.
struct Stamped {
  std::variant<link::Annotation, link::Request> message;
  Duration work{0};  ///< computed since the SUT resumed, as if alone
  SimTime st;
  WallTime wall;
};

/// The SUTs whose programs share the cores of a board, and their messages until it is known when,
/// on the board's time line, they were sent. If no program of a board ever waits for a core, its
/// programs are not in here: their own time is the board's.
///
/// A *pool* is the cores of a board that the same programs use: those that are pinned to one core,
/// or all others.
class SharedBoards {
 public:
  /// @throws Error(kInternal) if the boards of the options are not as documented.
  explicit SharedBoards(const RunOptions& options);

  bool shares(std::size_t uav) const { return seats_[uav].has_value(); }
  std::size_t pools() const { return pools_.size(); }
  const std::vector<std::size_t>& suts_of(std::size_t pool) const { return pools_[pool].uavs; }
  bool is_in(std::size_t pool, std::size_t uav) const {
    return shares(uav) && at(uav).pool == pool;
  }
  /// Its request has arrived, and its instant is not known yet.
  bool has_request(std::size_t uav) const;
  bool has_finish(std::size_t uav) const;

  /// @pre of the functions below: the SUT shares a board.
  /// @{
  void progress(std::size_t uav, Duration work);
  void add(std::size_t uav, Stamped message);
  /// It waits until `when`, or computes no more. After the request that `next` returned, or if a
  /// message ends its wait already at `when`.
  void resume(std::size_t uav, ExecTime when);
  void leave(std::size_t uav);
  /// Lower bound on the instants of its messages to come.
  ExecTime bound(std::size_t uav) const;
  /// @}

  struct Sent {
    std::size_t uav = 0;
    ExecTime at;
    Stamped what;
  };
  /// UAV, from, until, and on how much of a core its SUT computes.
  using Used = std::function<void(std::size_t uav, ExecTime from, ExecTime to, double cores)>;
  /// The next message of the SUTs of a pool, if its instant is known, and not after `until`; up to
  /// there, it can depend on nothing but their work.
  std::optional<Sent> next(std::size_t pool, ExecTime until, const Used& used);

 private:
  struct Pool {
    sync::SharedCores cores;
    std::vector<std::size_t> uavs;  // by program
  };
  struct Seat {
    std::size_t pool = 0;
    std::size_t program = 0;
    /// Its progress arrives at any time; others' ST must not depend on when annotations arrive.
    bool sends_progress = false;
    std::deque<Stamped> messages{};
    bool has_asked = false;  // for the first one
  };

  void seat(const RunOptions& options, std::vector<std::size_t> uavs, int cores);
  void ask(std::size_t uav);
  const Seat& at(std::size_t uav) const { return *seats_[uav]; }

  std::vector<Pool> pools_;
  std::vector<std::optional<Seat>> seats_;  // by UAV
};

}  // namespace tether::coordinator
