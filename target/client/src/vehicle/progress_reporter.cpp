#include "vehicle/progress_reporter.h"

#include "signals_blocked.h"

#include <utility>

#include <pthread.h>

#include <tether/link/messages.h>

namespace tether::client {

ProgressReporter::ProgressReporter(Duration period, TimeSource& source,
                                   std::function<bool()> report)
    : period_(period), source_(source), report_(std::move(report)) {
  const SignalsBlocked blocked;
  thread_ = std::thread([this] { run(); });
  // Not by itself: on a busy machine it begins late, and would be taken for one of the program's.
  static_cast<void>(::pthread_setname_np(thread_.native_handle(), link::kClientThread));
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
