#pragma once

#include <tether/base/time.h>
#include <tether/client/sut_clock.h>

namespace tether::as_is {

/// What the calling thread computes while one lives is not the program's. One within another one
/// does nothing.
class Unpaid {
 public:
  explicit Unpaid(client::TimeSource& source) : source_(&source) {
    if (current_ != nullptr) return;
    current_ = this;
    go_on();
  }
  ~Unpaid() {
    if (current_ != this) return;
    pause();
    current_ = nullptr;
  }
  Unpaid(const Unpaid&) = delete;
  Unpaid& operator=(const Unpaid&) = delete;

  /// So far: others that read the time do not see it.
  static void settle() {
    if (current_ == nullptr) return;
    current_->pause();
    current_->go_on();
  }
  /// A call of the vehicle, in which the clock stands anyway, unless there are other processes.
  template <class Call>
  static auto in_call(Call call) {
    if (current_ != nullptr && clock_stands_in_calls) current_->pause();
    auto result = call();
    if (current_ != nullptr && clock_stands_in_calls) current_->go_on();
    return result;
  }
  static inline bool clock_stands_in_calls = true;

 private:
  void go_on() { since_ = source_->counted_of_thread(); }
  void pause() { source_->leave_out(source_->counted_of_thread() - since_); }

  static thread_local Unpaid* current_ __attribute__((tls_model("initial-exec")));

  client::TimeSource* source_;
  Duration since_{0};
};

}  // namespace tether::as_is
