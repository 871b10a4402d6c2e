#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

#include <tether/campaign/result.h>
#include <tether/coordinator/coordinator.h>

namespace tether::runner {

/// Looks at the threads of SUTs on this machine. Not thread-safe.
class SutWatch {
 public:
  /// `port`: of the run's server.
  explicit SutWatch(std::uint16_t port) : port_(port) {}

  /// A SUT has connected from `address`. It is watched if `process`, as it calls itself, has that
  /// connection on this machine: not if it runs elsewhere, or in a container of its own.
  void joined(std::size_t uav, const std::string& address, std::uint32_t process);
  /// None: it is not watched.
  std::optional<coordinator::ThreadStates> states(std::size_t uav) const;

 private:
  std::uint16_t port_;
  std::map<std::size_t, pid_t> processes_;
};

/// What the looks at a SUT put in doubt. `clock`: of the SUT; `has_waits`: its replayed time does;
/// `sees_waits`: its own side makes interactions of them, as with tether-exec --as-is.
std::vector<campaign::Doubt> doubts_of(const coordinator::SutReport& sut,
                                       const computer::Clock& clock, bool has_waits = false,
                                       bool sees_waits = false);

}  // namespace tether::runner
