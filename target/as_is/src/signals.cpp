#include "signals.h"

#include "real.h"
#include "unpaid.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <utility>

#include <ucontext.h>
#include <unistd.h>

namespace tether::as_is {
namespace {

/// What the program has set for each signal that is handled here; no handler: it is not.
std::array<struct sigaction, NSIG> g_own{};
std::array<std::atomic<bool>, NSIG> g_is_own{};

struct Late {
  int signal;
  siginfo_t info;
};
constexpr std::size_t kMostLate = 16;
thread_local std::array<Late, kMostLate> t_late __attribute__((tls_model("initial-exec")));
thread_local std::size_t t_late_count __attribute__((tls_model("initial-exec"))) = 0;

std::atomic<int> g_unseen = 0;

/// A thread's own fault, which its handler has to see where it happens.
bool is_fault(int signal) {
  constexpr std::array kFaults = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGTRAP, SIGSYS, SIGABRT};
  return std::ranges::count(kFaults, signal) > 0;
}

}  // namespace

thread_local int Inside::depth_ = 0;
thread_local Unpaid* Unpaid::current_ = nullptr;
thread_local unsigned Signals::count_ = 0;
thread_local bool Signals::restarts_ = false;
thread_local bool Signals::is_open_ = false;
thread_local bool Signals::is_unseen_ = false;
thread_local int Signals::wake_ = -1;
std::atomic<std::atomic<int>*> Signals::unseen_ = &g_unseen;
thread_local bool Inside::has_late_ = false;

void Inside::end() {
  Signals::run_late();
}

Signals::Open::Open(int wake) {
  wake_ = wake;
  is_open_ = true;
  if (Inside::has_late_) run_late();
}

Signals::Open::~Open() {
  is_open_ = false;
  see();
}

void Signals::see() {
  if (std::exchange(is_unseen_, false)) --*unseen_.load();
}

int Signals::set(int signal, const struct sigaction* action, struct sigaction* old) {
  if (signal <= 0 || signal >= NSIG || is_fault(signal))
    return TETHER_REAL(sigaction)(signal, action, old);
  const auto index = static_cast<std::size_t>(signal);
  const struct sigaction before = g_own[index];
  const bool was_own = g_is_own[index];
  int result = 0;
  if (action == nullptr) {
    result = TETHER_REAL(sigaction)(signal, nullptr, old);
  } else {
    struct sigaction real = *action;
    const bool is_own = action->sa_handler != SIG_DFL && action->sa_handler != SIG_IGN;
    if (is_own) {
      g_own[index] = *action;  // before the first signal comes
      real.sa_sigaction = handle;
      real.sa_flags |= SA_SIGINFO;
    }
    result = TETHER_REAL(sigaction)(signal, &real, old);
    if (result == 0) g_is_own[index] = is_own;
  }
  if (result == 0 && old != nullptr && was_own) *old = before;
  return result;
}

void Signals::handle(int signal, siginfo_t* info, void* context) {
  const int kept = errno;
  if (Inside::is() && !is_open_ && t_late_count < kMostLate) {
    t_late[t_late_count++] = {signal, *info};
    Inside::has_late_ = true;
  } else {
    run(signal, info, context);
  }
  errno = kept;
}

// The program's, as if this library had not been at work.
void Signals::run(int signal, siginfo_t* info, void* context) {
  const struct sigaction own = g_own[static_cast<std::size_t>(signal)];
  const bool was_open = std::exchange(is_open_, false);
  see();  // the handler may never return
  const int depth = Inside::leave_all();
  const Unpaid::Paid paid;
  if ((own.sa_flags & SA_SIGINFO) != 0)
    own.sa_sigaction(signal, info, context);
  else
    own.sa_handler(signal);
  Inside::enter_again(depth);
  is_open_ = was_open;
  ++count_;
  restarts_ = (own.sa_flags & SA_RESTART) != 0;
  if (!was_open) return;
  ++*unseen_.load();
  is_unseen_ = true;
  constexpr std::uint64_t kOnce = 1;
  if (wake_ >= 0) static_cast<void>(TETHER_REAL(write)(wake_, &kOnce, sizeof kOnce));
}

void Signals::run_late() {
  while (t_late_count > 0) {
    Late one = t_late[0];
    --t_late_count;
    std::copy_n(t_late.begin() + 1, t_late_count, t_late.begin());
    ucontext_t none{};
    run(one.signal, &one.info, &none);
  }
  Inside::has_late_ = false;
}

bool Signals::have_run_since(unsigned count) {
  if (Inside::has_late_) run_late();
  return count_ != count;
}

}  // namespace tether::as_is
