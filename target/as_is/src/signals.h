#pragma once

#include <csignal>

namespace tether::as_is {

/// The program's handlers of signals. While its thread works for this library, holding what others
/// wait for, a handler that called it again could block for ever: then it runs when that is over.
class Signals {
 public:
  /// As sigaction(), of handlers that are run so.
  static int set(int signal, const struct sigaction* action, struct sigaction* old);

  /// Runs what came meanwhile. True: a handler has run in this thread since `count`.
  static bool have_run_since(unsigned count);
  static unsigned count() { return count_; }
  /// Whether the handler that ran last in this thread is one after which system calls go on.
  static bool restarts() { return restarts_; }

  /// While one lives, the calling thread waits, and holds nothing: handlers run at once.
  class Open {
   public:
    Open() { is_open_ = true; }
    ~Open() { is_open_ = false; }
    Open(const Open&) = delete;
    Open& operator=(const Open&) = delete;
  };

  /// As what came meanwhile, at the end of the library's work.
  static void run_late();

 private:
  static void handle(int signal, siginfo_t* info, void* context);
  static void run(int signal, siginfo_t* info, void* context);

  static thread_local unsigned count_ __attribute__((tls_model("initial-exec")));
  static thread_local bool restarts_ __attribute__((tls_model("initial-exec")));
  static thread_local bool is_open_ __attribute__((tls_model("initial-exec")));
};

}  // namespace tether::as_is
