#pragma once

#include <sys/resource.h>

/// For tests of processes that have reached their limit of open files.
namespace tether {

/// This process cannot open a file descriptor while the object lives; open ones stay open. One
/// object at a time; not thread-safe.
class NoMoreHandles {
 public:
  NoMoreHandles();
  ~NoMoreHandles();
  NoMoreHandles(const NoMoreHandles&) = delete;
  NoMoreHandles& operator=(const NoMoreHandles&) = delete;

  /// Whether exceptions work meanwhile: the undefined-behaviour sanitizer opens a pipe to inspect
  /// them.
  static bool allows_exceptions();

 private:
  rlimit before_{};
};

}  // namespace tether
