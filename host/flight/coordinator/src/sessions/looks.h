#pragma once

#include "time/timelines.h"

#include <vector>

#include <tether/coordinator/coordinator.h>

namespace tether::coordinator {

/// Looks at what the threads of SUTs do while they should compute: an estimate, by samples, of how
/// long a SUT waits on what is no interaction, and on how many threads it computes. Only the report
/// has it, because it is measured; nothing of the run depends on it but its end if a SUT waits for
/// too long. Times are arguments. Not thread-safe.
class ThreadLooks {
 public:
  using ThreadsOf = std::function<std::optional<ThreadStates>(std::size_t uav)>;

  ThreadLooks(std::size_t suts, const Timelines& times) : times_(&times), suts_(suts) {}

  /// `threads_of`: as in RunHooks; if it is empty, nothing is looked at.
  void begin(ThreadsOf threads_of, WallTime now);
  /// The SUT computes from now on.
  void computes(std::size_t uav, WallTime now);

  /// Until the next look is due; Duration::max(): no SUT is looked at.
  Duration until_due(const std::function<WallTime()>& clock) const;
  /// What was seen of one SUT.
  struct Look {
    std::size_t uav = 0;
    WallTime since;  ///< it computes
    ThreadStates states;
  };
  /// Looks at each SUT if that is due. `clock` is read again afterwards.
  std::vector<Look> look(const std::function<WallTime()>& clock);
  /// Counts a look if the SUT still computes: call it when all messages that it had sent by then
  /// have been handled. Returns how long it has waited since its last reply.
  Duration count(const Look& look);
  const SutLooks& of(std::size_t uav) const { return suts_[uav].looks; }

 private:
  struct Sut {
    WallTime computes_since{};  // its last reply was sent
    bool is_hidden = false;     // ThreadsOf does not know it
    SutLooks looks{};
    Duration waited_before{0};  // of `looks`, when its last reply was sent
    bool waits = false;         // it did so when it was looked at, but for…
    Duration served{0};         // … looks since then that found the client library at work
  };
  bool is_looked_at(std::size_t uav) const {
    return (*times_)[uav].facts().may_wait_unseen && !suts_[uav].is_hidden &&
           (*times_)[uav].is_computing();
  }

  const Timelines* times_;
  std::vector<Sut> suts_;
  ThreadsOf threads_of_;
  WallTime next_;  // when a look is due
  Duration period_ = std::chrono::milliseconds(2);
  Duration represented_{0};  // by the last look
};

}  // namespace tether::coordinator
