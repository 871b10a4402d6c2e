#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

#include <tether/base/time.h>
#include <tether/coordinator/coordinator.h>

namespace tether::runner {

/// The clocks of this machine that show a stall.
struct HostClocks {
  WallTime running;  ///< stopped while the machine is suspended
  WallTime since_boot;
};
HostClocks host_clocks();

/// Detects unintended stalls of a run. Reports each when it happens and notes it for the result,
/// because wall times of the run are then not those of the software. Pure except for `stopped_sut`.
/// Not thread-safe.
class StallWatch {
 public:
  /// @param stopped_sut returns which SUT's process is stopped; called once a second during a
  /// stall.
  StallWatch(std::function<std::optional<std::string>()> stopped_sut, HostClocks now);

  /// Checks the run's status at `now`; returns a line to report now, or an empty string.
  std::string check(const coordinator::RunStatus& status, HostClocks now);
  /// At the end of the run: notes for the result, one line each.
  std::vector<std::string> notes(HostClocks now) const;
  /// Of these, the first one on a SUT that was stopped; empty: none was.
  const std::string& stopped_program() const { return stopped_program_; }

 private:
  std::string find_stopped_sut(const coordinator::RunStatus& status);

  std::function<std::optional<std::string>()> stopped_sut_;
  HostClocks began_;
  WallTime last_check_;
  WallTime last_asked_{};
  bool stalled_ = false;
  std::vector<std::string> notes_;
  std::string stopped_program_;
};

/// A process of this group that is stopped by a signal or a debugger, if there is one.
std::optional<pid_t> stopped_process(pid_t group);

}  // namespace tether::runner
