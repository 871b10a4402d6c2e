#pragma once

#include <sys/resource.h>

/// For tests of what happens where a process may open no more files.
namespace tether {

/// This process gets no new file descriptor while the object lives; those it has stay. One at a
/// time; not thread-safe.
class NoMoreHandles {
 public:
  NoMoreHandles();
  ~NoMoreHandles();
  NoMoreHandles(const NoMoreHandles&) = delete;
  NoMoreHandles& operator=(const NoMoreHandles&) = delete;

  /// Whether exceptions can be made meanwhile: the undefined-behaviour sanitizer opens a pipe to
  /// look at one.
  static bool allows_exceptions();

 private:
  rlimit before_{};
};

}  // namespace tether
