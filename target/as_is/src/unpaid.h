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
  /// While one lives, what the calling thread computes is the program's again: a handler of a
  /// signal, and waiting in the kernel, which is as dear as the program's own waiting.
  class Paid {
   public:
    explicit Paid(bool is_any = true) : unpaid_(is_any ? current_ : nullptr) {
      if (unpaid_ == nullptr) return;
      unpaid_->pause();
      current_ = nullptr;
    }
    ~Paid() {
      if (unpaid_ == nullptr) return;
      current_ = unpaid_;
      unpaid_->go_on();
    }
    Paid(const Paid&) = delete;
    Paid& operator=(const Paid&) = delete;

   private:
    Unpaid* unpaid_;
  };
  /// A call of the vehicle, in which the clock stands anyway, unless there are other processes.
  template <class Call>
  static auto in_call(Call call) {
    if (!clock_stands_in_calls) settle();
    const Paid paid(clock_stands_in_calls);
    return call();
  }
  static inline bool clock_stands_in_calls = true;

 private:
  void go_on() { since_ = source_->begin_to_leave_out(); }
  void pause() { source_->leave_out(source_->counted_of_thread() - since_); }

  static thread_local Unpaid* current_ __attribute__((tls_model("initial-exec")));

  client::TimeSource* source_;
  Duration since_{0};
};

}  // namespace tether::as_is
