#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include <tether/os/child_process.h>

namespace tether::autopilot {

/// A flight controller that runs as a program of its own, on one core: whoever gives it its time
/// lets it come to rest before he goes on. It ends with the object. Not thread-safe.
class HeldProgram {
 public:
  /// @throws Error(kSetup) if it cannot be started
  HeldProgram(std::string name, os::ChildCommand command);

  /// Calls `send`, which wakes a thread of the program, then `serve` again and again until that has
  /// had a core, all threads of the program wait for something, and none got a core between two
  /// looks; and once more then.
  /// @throws Error(kLinkLost) if it has ended, with the last line of its log; Error(kHung) if it
  /// does not come to rest
  void let_rest(const std::function<void()>& send, const std::function<void()>& serve);
  /// @throws Error(kLinkLost) as above
  void require_alive();
  /// Where its output goes.
  const std::filesystem::path& log() const { return log_; }

 private:
  std::string name_;
  std::filesystem::path log_;
  os::ChildProcess process_;
};

}  // namespace tether::autopilot
