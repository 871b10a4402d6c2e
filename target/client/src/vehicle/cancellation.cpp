#include "vehicle/cancellation.h"

#include <utility>

namespace tether::client {
namespace {

thread_local Cancellation* t_cancellation = nullptr;

}  // namespace

void Cancellation::cancel() {
  const std::lock_guard lock(mutex_);
  cancelled_ = true;
  if (unblock_) unblock_();
}

bool Cancellation::is_cancelled() const {
  const std::lock_guard lock(mutex_);
  return cancelled_;
}

Cancellation::Scope::Scope(Cancellation& cancellation) {
  t_cancellation = &cancellation;
}
Cancellation::Scope::~Scope() {
  t_cancellation = nullptr;
}

Cancellation* Cancellation::of_this_thread() {
  return t_cancellation;
}

Cancellation::Wait::Wait(Cancellation* cancellation, std::function<void()> unblock)
    : cancellation_(cancellation) {
  if (cancellation_ == nullptr) return;
  const std::lock_guard lock(cancellation_->mutex_);
  cancellation_->unblock_ = std::move(unblock);
  if (cancellation_->cancelled_) cancellation_->unblock_();
}

Cancellation::Wait::~Wait() {
  if (cancellation_ == nullptr) return;
  const std::lock_guard lock(cancellation_->mutex_);
  cancellation_->unblock_ = nullptr;
}

}  // namespace tether::client
