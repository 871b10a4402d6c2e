#pragma once

#include <atomic>
#include <thread>

#include <sys/types.h>

#include <tether/base_testing/sanitizer.h>

namespace tether::system_test {

#if TETHER_ADDRESS_SANITIZER || TETHER_THREAD_SANITIZER
inline constexpr bool kMemoryIsTethers = false;  // a sanitizer keeps what was freed
#else
inline constexpr bool kMemoryIsTethers = true;
#endif

/// Samples a process' largest memory until it ends or this is destroyed.
class MemoryWatch {
 public:
  explicit MemoryWatch(pid_t pid);
  /// [KiB]
  long most_KiB() const { return most_KiB_; }

 private:
  std::atomic<long> most_KiB_{0};
  std::jthread thread_;
};

}  // namespace tether::system_test
