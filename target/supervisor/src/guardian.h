#pragma once

#include <string>

#include <sys/types.h>

#include <tether/os/file_descriptor.h>

namespace tether::supervisor {

/// A small process that outlives this one, however it ends, and clears up after it: kills what is
/// left of the commands' processes, stopped or not, and removes the cgroup and the private folder.
class Guardian {
 public:
  /// `cgroup` may be empty. To be made while this process has one thread and before a command is
  /// started. Without one (the system refuses) `is_there` is false.
  Guardian(const std::string& folder, const std::string& cgroup);
  /// Has it clear up, and waits until it has.
  ~Guardian();
  Guardian(const Guardian&) = delete;
  Guardian& operator=(const Guardian&) = delete;

  bool is_there() const { return process_ > 0; }
  pid_t process() const { return process_; }
  /// The process group of a command.
  void watch(pid_t group);
  /// One that was watched, and of which nothing is left.
  void forget(pid_t group);

 private:
  os::FileDescriptor pipe_;
  pid_t process_ = -1;
};

}  // namespace tether::supervisor
