#pragma once

#include <atomic>
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

  /// While one lives, the calling thread waits, and holds nothing: handlers run at once, also those
  /// that came before. One that runs when the thread has looked and does not wait yet would not end
  /// that wait. So it writes to `wake`, an eventfd that the thread waits for (−1: none), and nobody
  /// may let ET go on before the thread has looked again.
  class Open {
   public:
    explicit Open(int wake = -1);
    ~Open();
    Open(const Open&) = delete;
    Open& operator=(const Open&) = delete;
  };

  /// Whether all threads have looked since handlers ran in them.
  static bool are_seen() { return *unseen_.load() == 0; }
  /// Counts those that have not there, for other processes.
  static void count_unseen_in(std::atomic<int>& count) { unseen_ = &count; }

  /// As what came meanwhile, at the end of the library's work.
  static void run_late();

 private:
  static void handle(int signal, siginfo_t* info, void* context);
  static void run(int signal, siginfo_t* info, void* context);
  static void see();

  static std::atomic<std::atomic<int>*> unseen_;
  static thread_local unsigned count_ __attribute__((tls_model("initial-exec")));
  static thread_local bool restarts_ __attribute__((tls_model("initial-exec")));
  static thread_local bool is_open_ __attribute__((tls_model("initial-exec")));
  static thread_local bool is_unseen_ __attribute__((tls_model("initial-exec")));
  static thread_local int wake_ __attribute__((tls_model("initial-exec")));
};

}  // namespace tether::as_is
