#pragma once

#include <functional>
#include <mutex>

namespace tether::client {

/// Lets one thread end the calls of another that wait for a reply. The thread whose calls may be
/// ended lives within a Scope; a vehicle that is about to wait for it says how to unblock the wait.
/// Thread-safe.
class Cancellation {
 public:
  /// Ends the present wait of the thread, and all later ones.
  void cancel();
  bool is_cancelled() const;

  /// Makes it the calling thread's own, as long as this lives.
  class Scope {
   public:
    explicit Scope(Cancellation& cancellation);
    ~Scope();
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;
  };
  /// Of the calling thread; null: its calls are never cancelled.
  static Cancellation* of_this_thread();

  /// A wait that `unblock` ends, from any thread. It may be called at once.
  class Wait {
   public:
    /// `cancellation` may be null.
    Wait(Cancellation* cancellation, std::function<void()> unblock);
    ~Wait();
    Wait(const Wait&) = delete;
    Wait& operator=(const Wait&) = delete;

   private:
    Cancellation* cancellation_;
  };

 private:
  mutable std::mutex mutex_;
  bool cancelled_ = false;         // guarded by mutex_, as is the next
  std::function<void()> unblock_;  // called with the mutex held, so that it ends before its Wait
};

}  // namespace tether::client
