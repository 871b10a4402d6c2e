#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

#include <tether/base/time.h>
#include <tether/coordinator/coordinator.h>

namespace tether::runner {

/// This machine's clocks, as far as a stall shows in them.
struct HostClocks {
  WallTime running;  ///< stands still while the machine is suspended
  WallTime since_boot;
};
HostClocks host_clocks();

/// Sees where a run stood still that nobody meant to: says it when it happens, and keeps it for the
/// result, whose times might otherwise be taken for those of the software. Pure but for
/// `stopped_sut`. Not thread-safe.
class StallWatch {
 public:
  /// @param stopped_sut asked about once a second while nothing moves: whose process is stopped.
  StallWatch(std::function<std::optional<std::string>()> stopped_sut, HostClocks now);

  /// The run's status at `now`. What is to be said now, one line; empty: nothing.
  std::string look(const coordinator::RunStatus& status, HostClocks now);
  /// At the end of the run: what the result should tell, one line each.
  std::vector<std::string> notes(HostClocks now) const;

 private:
  std::string look_for_stopped_sut(const coordinator::RunStatus& status);

  std::function<std::optional<std::string>()> stopped_sut_;
  HostClocks began_;
  WallTime last_look_;
  WallTime last_asked_{};
  bool stalled_ = false;
  std::vector<std::string> notes_;
};

/// The process of this group that is stopped by a signal or a debugger, if one is.
std::optional<pid_t> stopped_process(pid_t group);

}  // namespace tether::runner
