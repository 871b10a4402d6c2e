#pragma once

#include <map>

#include <sys/types.h>

#include <tether/client/exec/group_page.h>
#include <tether/os/file_descriptor.h>

namespace tether::supervisor {

/// The kernel's view of the threads that are in a page. Their files stay open: looking takes some
/// microseconds for each, and no name is looked up of a process that is about to end, which can
/// keep the kernel busy for seconds.
class ThreadFiles {
 public:
  /// `except`: a child of this process that is none of the program.
  explicit ThreadFiles(pid_t except) : except_(except) {}

  /// Whether no thread runs or could, of those in the page and of their processes' children that
  /// are not in there yet. All of them, and the caller, are on one core. Takes out what has ended.
  bool are_all_waiting(client::GroupPage& page);

 private:
  struct Files {
    os::FileDescriptor stat, children, where;
  };
  bool may_bury_child(Files& files, pid_t process, pid_t id) const;
  bool are_known_or_waiting(const os::FileDescriptor& children, client::GroupPage& page) const;

  pid_t except_;
  std::map<pid_t, Files> files_;  // by thread
  os::FileDescriptor own_children_;
};

}  // namespace tether::supervisor
