#pragma once

#include <initializer_list>

#include <pthread.h>
#include <signal.h>

namespace tether::client {

/// As long as it lives, the calling thread takes no signals, except those, and the threads that it
/// starts take none for good: a thread inherits the signal mask of its creator.
class SignalsBlocked {
 public:
  SignalsBlocked(std::initializer_list<int> except = {}) {
    sigset_t blocked;
    ::sigfillset(&blocked);
    for (const int signal : except) ::sigdelset(&blocked, signal);
    ::pthread_sigmask(SIG_BLOCK, &blocked, &before_);
  }
  ~SignalsBlocked() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  SignalsBlocked(const SignalsBlocked&) = delete;
  SignalsBlocked& operator=(const SignalsBlocked&) = delete;

 private:
  sigset_t before_{};
};

}  // namespace tether::client
