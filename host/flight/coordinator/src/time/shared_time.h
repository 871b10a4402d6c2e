#pragma once

#include "time/own_time.h"

#include <functional>
#include <vector>

#include <tether/sync/shared_cores.h>

namespace tether::coordinator {

class SharedTime;

/// The cores of a modelled board that the same programs use: those that are pinned to one core, or
/// all others (DESIGN section 2, "Several programs on one board"). A SUT stamps its own work; its
/// messages wait until it is known when, on the board's time line, they were sent.
class Pool {
 public:
  Pool(int cores, std::size_t suts) : cores_(cores, suts) {}

  /// The time of its next SUT, which is serial. The pool must outlive it.
  std::unique_ptr<Timeline> add(const SutStart& sut);
  bool has(std::size_t uav) const;

  /// UAV, from, until, and on how much of a core its SUT computes.
  using Used = std::function<void(std::size_t uav, ExecTime from, ExecTime to, double cores)>;
  /// The next message of its SUTs, if its instant is known, and not after `until`; up to there, it
  /// can depend on nothing but their work.
  std::optional<Sent> next(ExecTime until, const Used& used);
  /// Whether the bound of one of them has grown by what is known now.
  bool raise_bounds();
  /// Whether a message from outside can end the wait of one of them.
  bool awaits_message() const;

 private:
  friend SharedTime;
  sync::SharedCores cores_;
  std::vector<SharedTime*> suts_;  // by program
};

}  // namespace tether::coordinator
