// Threads, timed waits for each other, and the end of the process, in place of the C library's.

#include "clocks.h"
#include "in_place.h"
#include "signals.h"

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstring>
#include <memory>

#include <linux/futex.h>
#include <pthread.h>
#include <semaphore.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace tether::as_is {
namespace {

struct Begin {
  void* (*function)(void*);
  void* argument;
  bool is_inside;  // a thread of this library
  client::GroupPage::Thread* shared = nullptr;
};

// What a thread of the program leaves behind when it ends, however it does.
struct OfProgram {
  explicit OfProgram(client::GroupPage::Thread* thread) : shared(thread) {}
  ~OfProgram() {
    client::GroupPage::end_thread(shared);
    Threads::ended();
  }
  OfProgram(const OfProgram&) = delete;
  OfProgram& operator=(const OfProgram&) = delete;

  client::GroupPage::Thread* shared;
};

void* begin(void* argument) {
  const std::unique_ptr<Begin> given(static_cast<Begin*>(argument));
  const Begin copy = *given;
  if (copy.is_inside) {
    const Inside inside;
    return copy.function(copy.argument);
  }
  if (copy.shared != nullptr) copy.shared->id = ::gettid();
  thread_local const OfProgram kOfProgram(copy.shared);
  static_cast<void>(&kOfProgram);
  return copy.function(copy.argument);
}

/// `take(slice)`: the real wait, for so long in real time; ETIMEDOUT: not yet.
/// `condition`: what it waits for; nullptr: a call that this library's signal interrupts.
/// `ends_by_handler`: also if a handler of the program runs that nothing goes on after.
template <class Take>
int wait_until(Agent& agent, clockid_t clock, const timespec* until, Take take,
               bool ends_by_handler, pthread_cond_t* condition = nullptr) {
  if (!duration_of(*until)) return EINVAL;
  const ExecTime deadline = et_of(clock, *until);
  int result = ETIMEDOUT;
  std::atomic<bool> is_interrupted = false;
  const auto interrupt = [&, thread = ::pthread_self()] {
    is_interrupted = true;
    if (condition != nullptr) return static_cast<void>(::pthread_cond_broadcast(condition));
    interrupt_thread(thread);
  };
  const unsigned handled = Signals::count();
  const auto is_ended = [&] {
    return ends_by_handler && Signals::have_run_since(handled) && !Signals::restarts();
  };
  const auto block = [&](Duration slice) {
    if (is_ended()) return true;
    timespec real{};
    TETHER_REAL(clock_gettime)(CLOCK_REALTIME, &real);
    const timespec end = to_timespec(duration_of(real).value_or(Duration(0)) + slice);
    result = take(&end);
    // Python asks for its lock only if the wait for it timed out. Who was woken by the program at
    // the same instant may go on: the others that wait for the condition were woken, too.
    const bool can_be_interrupt = result == EINTR || (result == 0 && condition != nullptr);
    if (can_be_interrupt && is_interrupted.exchange(false)) result = ETIMEDOUT;
    return result != ETIMEDOUT || is_ended();
  };
  const Inside inside;
  agent.wait_for_thread(deadline, block, interrupt);
  return result == ETIMEDOUT && is_ended() ? EINTR : result;
}

// Which clock a condition has is not told. What the two show is a billion seconds apart.
clockid_t clock_of(const timespec& until) {
  constexpr time_t kBetween_s = 500'000'000;
  return until.tv_sec < kBetween_s ? CLOCK_MONOTONIC : CLOCK_REALTIME;
}

int wait_for_condition(Agent& agent, pthread_cond_t* condition, pthread_mutex_t* mutex,
                       clockid_t clock, const timespec* until) {
  return wait_until(
      agent, clock, until,
      [&](const timespec* end) {
        return TETHER_REAL(pthread_cond_clockwait)(condition, mutex, CLOCK_REALTIME, end);
      },
      false, condition);
}

int wait_for_semaphore(Agent& agent, sem_t* semaphore, clockid_t clock, const timespec* until) {
  if (TETHER_REAL(sem_trywait)(semaphore) == 0) return 0;
  const auto take = [&](const timespec* end) {
    return TETHER_REAL(sem_timedwait)(semaphore, end) == 0 ? 0 : errno;
  };
  const int result = wait_until(agent, clock, until, take, true);
  if (result == 0) return 0;
  errno = result;
  return -1;
}

// The library of C++ waits for futures and semaphores so.
long wait_for_futex(Agent& agent, long word, long operation, long value, const timespec& timeout,
                    long bits) {
  const bool is_absolute = (operation & FUTEX_CMD_MASK) == FUTEX_WAIT_BITSET;
  const clockid_t clock =
      (operation & FUTEX_CLOCK_REALTIME) != 0 ? CLOCK_REALTIME : CLOCK_MONOTONIC;
  const Inside inside;
  const timespec until =
      is_absolute ? timeout
                  : shown(clock, agent.now() + duration_of(timeout).value_or(Duration(0)));
  const long plain = FUTEX_WAIT_BITSET | FUTEX_CLOCK_REALTIME | (operation & FUTEX_PRIVATE_FLAG);
  const long mask = is_absolute ? bits : static_cast<long>(FUTEX_BITSET_MATCH_ANY);
  const auto take = [&](const timespec* end) {
    return TETHER_REAL(syscall)(SYS_futex, word, plain, value, end, 0L, mask) == 0 ? 0 : errno;
  };
  const int result = wait_until(agent, clock, &until, take, true);
  errno = result;
  return result == 0 ? 0 : -1;
}

/// Of C11: its header has the name of one here.
int thread_result(int error) {
  constexpr int kSuccess = 0, kError = 2, kTimedOut = 4;  // thrd_success and so on
  return error == 0 ? kSuccess : error == ETIMEDOUT ? kTimedOut : kError;
}

bool is_timed_wait(long operation) {
  const long command = operation & FUTEX_CMD_MASK;
  return command == FUTEX_WAIT || command == FUTEX_WAIT_BITSET;
}

}  // namespace

void interrupt_thread(pthread_t thread) {
  static const int kSignal = [] {
    const int signal = SIGRTMAX - 4;
    struct sigaction action {};
    action.sa_handler = [](int) {};
    ::sigaction(signal, &action, nullptr);
    return signal;
  }();
  ::pthread_kill(thread, kSignal);
}

void start_thread(const sigevent& event) {
  struct Call {
    void (*function)(sigval);
    sigval value;
  };
  auto* const call = new Call{event.sigev_notify_function, event.sigev_value};
  const auto run = [](void* argument) -> void* {
    const std::unique_ptr<Call> own(static_cast<Call*>(argument));
    own->function(own->value);
    return nullptr;
  };
  Agent* const agent = Agent::get();
  auto given = std::make_unique<Begin>(Begin{run, call, false});
  if (agent != nullptr) given->shared = agent->thread_begins();
  Threads::began();
  pthread_t thread{};
  if (TETHER_REAL(pthread_create)(&thread, event.sigev_notify_attributes, begin, given.get()) !=
      0) {
    client::GroupPage::end_thread(given->shared);
    return Threads::ended();
  }
  static_cast<void>(given.release());
  ::pthread_detach(thread);
}

}  // namespace tether::as_is

using namespace tether::as_is;

TETHER_IN_PLACE int pthread_create(pthread_t* __restrict thread,
                                   const pthread_attr_t* __restrict attributes,
                                   void* (*function)(void*), void* __restrict argument) {
  const bool is_inside = Inside::is();
  auto given = std::make_unique<Begin>(Begin{function, argument, is_inside});
  Agent* const agent = tether::as_is::agent();
  if (agent != nullptr) given->shared = agent->thread_begins();
  if (!is_inside) Threads::began();
  // Signals are the program's: its own threads have to take them.
  sigset_t all, before;
  ::sigfillset(&all);
  if (is_inside) ::pthread_sigmask(SIG_SETMASK, &all, &before);
  const int result = TETHER_REAL(pthread_create)(thread, attributes, begin, given.get());
  if (is_inside) ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  if (result == 0)
    static_cast<void>(given.release());
  else if (!is_inside) {
    tether::client::GroupPage::end_thread(given->shared);
    Threads::ended();
  }
  return result;
}

TETHER_IN_PLACE int pthread_cond_timedwait(pthread_cond_t* __restrict condition,
                                           pthread_mutex_t* __restrict mutex,
                                           const timespec* __restrict until) {
  Agent* const agent = tether::as_is::agent();
  if (agent == nullptr) return TETHER_REAL(pthread_cond_timedwait)(condition, mutex, until);
  return wait_for_condition(*agent, condition, mutex, clock_of(*until), until);
}

TETHER_IN_PLACE int pthread_cond_clockwait(pthread_cond_t* condition, pthread_mutex_t* mutex,
                                           clockid_t clock, const timespec* until) {
  Agent* const agent = tether::as_is::agent();
  if (agent == nullptr) return TETHER_REAL(pthread_cond_clockwait)(condition, mutex, clock, until);
  return wait_for_condition(*agent, condition, mutex, clock, until);
}

TETHER_IN_PLACE int pthread_mutex_clocklock(pthread_mutex_t* mutex, clockid_t clock,
                                            const timespec* until) {
  Agent* const agent = tether::as_is::agent();
  if (agent == nullptr) return TETHER_REAL(pthread_mutex_clocklock)(mutex, clock, until);
  const auto take = [&](const timespec* end) {
    return TETHER_REAL(pthread_mutex_clocklock)(mutex, CLOCK_REALTIME, end);
  };
  return wait_until(*agent, clock, until, take, false);
}

TETHER_IN_PLACE int pthread_mutex_timedlock(pthread_mutex_t* __restrict mutex,
                                            const timespec* __restrict until) {
  return pthread_mutex_clocklock(mutex, CLOCK_REALTIME, until);
}

// In glibc, the conditions and mutexes of C11 are those of POSIX.
TETHER_IN_PLACE int cnd_timedwait(pthread_cond_t* __restrict condition,
                                  pthread_mutex_t* __restrict mutex,
                                  const timespec* __restrict until) {
  return thread_result(pthread_cond_timedwait(condition, mutex, until));
}

TETHER_IN_PLACE int mtx_timedlock(pthread_mutex_t* __restrict mutex,
                                  const timespec* __restrict until) {
  return thread_result(pthread_mutex_timedlock(mutex, until));
}

TETHER_IN_PLACE int sem_timedwait(sem_t* __restrict semaphore, const timespec* __restrict until) {
  Agent* const agent = tether::as_is::agent();
  if (agent == nullptr) return TETHER_REAL(sem_timedwait)(semaphore, until);
  return wait_for_semaphore(*agent, semaphore, CLOCK_REALTIME, until);
}

TETHER_IN_PLACE int sem_clockwait(sem_t* semaphore, clockid_t clock, const timespec* until) {
  Agent* const agent = tether::as_is::agent();
  if (agent == nullptr) return TETHER_REAL(sem_clockwait)(semaphore, clock, until);
  return wait_for_semaphore(*agent, semaphore, clock, until);
}

TETHER_IN_PLACE long syscall(long number, ...) {
  va_list list;
  va_start(list, number);
  long a[6];
  for (long& argument : a) argument = va_arg(list, long);
  va_end(list);
  if (const auto result = device_call(number, a)) return *result;
  if (const auto result = time_call(number, a)) return *result;
  Agent* const agent = number == SYS_futex ? tether::as_is::agent() : nullptr;
  if (agent == nullptr || a[3] == 0 || !is_timed_wait(a[1]))
    return TETHER_REAL(syscall)(number, a[0], a[1], a[2], a[3], a[4], a[5]);
  const timespec* timeout = nullptr;
  std::memcpy(&timeout, &a[3], sizeof a[3]);
  return wait_for_futex(*agent, a[0], a[1], a[2], *timeout, a[5]);
}

TETHER_IN_PLACE void _exit(int code) {
  if (Agent* const agent = tether::as_is::agent()) {
    const Inside inside;
    if (agent->is_here()) agent->finish(code);
  }
  TETHER_REAL(_exit)(code);
  __builtin_unreachable();
}
