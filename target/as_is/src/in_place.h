#pragma once

#include "agent.h"
#include "real.h"

#include <cerrno>
#include <optional>

#include <pthread.h>

/// What the functions in place of the C library's have in common.
#define TETHER_IN_PLACE extern "C" __attribute__((visibility("default")))

namespace tether::as_is {

/// Keeps errno, which calls that succeed leave alone.
class KeepErrno {
 public:
  KeepErrno() : kept_(errno) {}
  ~KeepErrno() { errno = kept_; }
  KeepErrno(const KeepErrno&) = delete;
  KeepErrno& operator=(const KeepErrno&) = delete;

 private:
  int kept_;
};

/// The agent, if the calling thread is the program's and the process is under test; else nullptr:
/// then the real function is what is wanted.
inline Agent* agent() {
  return Inside::is() ? nullptr : Agent::get();
}

/// Ends what the thread waits for in a system call, by a signal that programs do not use. One that
/// blocks it is late by a slice.
void interrupt_thread(pthread_t thread);

/// What a system call for a device comes to, −1 with errno; none: it is for something else.
std::optional<long> device_call(long number, const long (&arguments)[6]);

/// What a system call for the time or a sleep comes to, as above.
std::optional<long> time_call(long number, const long (&arguments)[6]);

}  // namespace tether::as_is
