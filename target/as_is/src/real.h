#pragma once

#include <utility>

#include <dlfcn.h>

/// The C library's own functions, behind those that this library has in their place.
namespace tether::as_is {

/// `TETHER_REAL(poll)(fds, count, timeout)`.
#define TETHER_REAL(function)                                                   \
  ([] {                                                                         \
    static const auto kReal =                                                   \
        reinterpret_cast<decltype(&::function)>(::dlsym(RTLD_NEXT, #function)); \
    return kReal;                                                               \
  }())

/// While one lives, the calling thread works for this library, and gets the real functions. Threads
/// that it makes meanwhile do so for ever.
class Inside {
 public:
  Inside() { ++depth_; }
  ~Inside() {
    if (--depth_ == 0 && has_late_) end();
  }
  Inside(const Inside&) = delete;
  Inside& operator=(const Inside&) = delete;

  static bool is() { return depth_ > 0; }

  /// For the program's handlers of signals (signals.h).
  static int leave_all() { return std::exchange(depth_, 0); }
  static void enter_again(int depth) { depth_ = depth; }
  static thread_local bool has_late_ __attribute__((tls_model("initial-exec")));

 private:
  static void end();

  static thread_local int depth_ __attribute__((tls_model("initial-exec")));
};

}  // namespace tether::as_is
