// Handlers of signals, and waits for signals, in place of the C library's.

#include "clocks.h"
#include "in_place.h"
#include "signals.h"

#include <cerrno>
#include <csignal>

using namespace tether::as_is;

TETHER_IN_PLACE int sigaction(int signal, const struct sigaction* __restrict action,
                              struct sigaction* __restrict old) {
  if (agent() == nullptr) return TETHER_REAL(sigaction)(signal, action, old);
  return Signals::set(signal, action, old);
}

TETHER_IN_PLACE sighandler_t signal(int number, sighandler_t handler) {
  if (agent() == nullptr) return TETHER_REAL(signal)(number, handler);
  struct sigaction action {
  }, old{};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  ::sigaddset(&action.sa_mask, number);
  return Signals::set(number, &action, &old) == 0 ? old.sa_handler : SIG_ERR;
}

TETHER_IN_PLACE int sigtimedwait(const sigset_t* __restrict wanted, siginfo_t* __restrict info,
                                 const timespec* __restrict timeout) {
  Agent* const agent = tether::as_is::agent();
  if (agent == nullptr || timeout == nullptr)
    return TETHER_REAL(sigtimedwait)(wanted, info, timeout);
  const auto wait = duration_of(*timeout);
  if (!wait) {
    errno = EINVAL;
    return -1;
  }
  const int kept = errno;
  const Inside inside;
  int result = -1;
  int error = EAGAIN;
  const unsigned handled = Signals::count();
  agent->wait_for_thread(
      agent->now() + *wait,
      [&](tether::Duration slice) {
        if (Signals::have_run_since(handled)) {
          error = EINTR;
          return true;
        }
        const timespec real = to_timespec(slice);
        result = TETHER_REAL(sigtimedwait)(wanted, info, &real);
        error = errno;
        // A stop interrupts it as well.
        const bool is_over = error != EAGAIN && error != EINTR;
        return result > 0 || is_over || Signals::have_run_since(handled);
      },
      [thread = ::pthread_self()] { interrupt_thread(thread); });
  errno = result > 0 ? kept : error == EINTR ? EINTR : EAGAIN;
  return result;
}
