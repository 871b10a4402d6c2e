#include "progress_reporter.h"

#include <utility>

#include <pthread.h>
#include <signal.h>

namespace tether::client {
namespace {

/// A thread inherits the signal mask of its creator.
class SignalsBlocked {
 public:
  SignalsBlocked() {
    sigset_t all;
    ::sigfillset(&all);
    ::pthread_sigmask(SIG_SETMASK, &all, &before_);
  }
  ~SignalsBlocked() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  SignalsBlocked(const SignalsBlocked&) = delete;
  SignalsBlocked& operator=(const SignalsBlocked&) = delete;

 private:
  sigset_t before_{};
};

}  // namespace

ProgressReporter::ProgressReporter(Duration period, TimeSource& source,
                                   std::function<bool()> report)
    : period_(period), source_(source), report_(std::move(report)) {
  const SignalsBlocked blocked;
  thread_ = std::thread([this] { run(); });
}

ProgressReporter::~ProgressReporter() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  stop_.notify_one();
  thread_.join();
}

void ProgressReporter::run() {
  source_.exclude_calling_thread();
  std::unique_lock lock(mutex_);
  while (!stop_.wait_for(lock, period_, [this] { return stopping_; }) && report_()) {
  }
  source_.release_calling_thread();
}

}  // namespace tether::client
