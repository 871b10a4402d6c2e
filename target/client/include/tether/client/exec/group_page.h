#pragma once

#include <array>
#include <atomic>
#include <csignal>  // pid_t
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include <tether/base/result.h>
#include <tether/base/time.h>
#include <tether/client/exec/computed.h>
#include <tether/client/sut_clock.h>

namespace tether::client {

/// What the processes of one program have in common that knows nothing of Tether, in shared memory
/// (ADR 0095): their execution time, and until when they wait.
/// tether-exec publishes the course of ET; each process reads it, and registers itself and its
/// waits.
///
/// ET grows by the CPU time of all processes × factor. They share one core, so whoever reads it is
/// the only one that runs.
class GroupPage {
 public:
  static constexpr std::size_t kProcesses = 512, kThreads = 4096, kWaits = 4096;
  /// Of a wait without a deadline, and of a process without a timer.
  static constexpr ExecTime kNever = ExecTime::max();

  /// A process of the program. What follows `fixed_ns` is its own to write.
  struct Process {
    std::atomic<pid_t> id{0};                           // 0: none
    std::atomic<std::int64_t> used_ns{0}, fixed_ns{0};  ///< seen last; what used() had of that
    std::atomic<ExecTime> timer{kNever};       ///< its first timer that is a descriptor expires
    std::atomic<std::uint64_t> sensors{0};     ///< bit: index of a sensor that wakes it
    std::atomic<bool> listens{false};          ///< it has a port of the flight controller
    std::array<std::atomic<char>, 48> name{};  ///< ends with a 0
    std::atomic<int> unseen{0};                ///< its threads that will hear of a signal

    void call(std::string_view text);
    std::string called() const;
  };
  /// A thread waits until then.
  struct Wait {
    std::atomic<pid_t> process{0};  // 0: free
    std::atomic<ExecTime> deadline{kNever};
    std::atomic<Duration> told_at{Duration(0)};  // by the machine's clock
    std::atomic<int> tellings{0};
  };

  /// A thread of a process; `id` is kBegins until it knows that.
  struct Thread {
    std::atomic<pid_t> id{0};  // 0: free
    std::atomic<pid_t> process{0};
  };
  static constexpr pid_t kBegins = -1;

  GroupPage() = default;
  GroupPage(const GroupPage&) = delete;
  GroupPage& operator=(const GroupPage&) = delete;

  /// Adds a process, from its first instruction on, and its first thread; or finds it. nullptr:
  /// there are too many.
  Process* enter(pid_t process);
  bool has(pid_t process) const;
  /// Adds a thread. nullptr: there are too many.
  Thread* begin_thread(pid_t process, pid_t id);
  static void end_thread(Thread* thread);
  /// A process begins with another program: it has one thread, which does not wait.
  void begin_again(pid_t process);
  /// Takes those out that have ended, and adds their time to `computed`; what they have computed
  /// stays. For tether-exec.
  void forget_ended(Computed& computed);
  /// Adds the time of those that are there.
  void add_present(Computed& computed) const;
  /// CPU time of all processes that have entered, less what was left out. Monotone: who reads it
  /// fixes it. Each nanosecond that is not left out is in it exactly once, as soon as it was spent.
  Duration used() const;
  /// So much of what a thread of `own` has computed just now does not count. What used() had
  /// already stays charged, because what is computed next would be free otherwise.
  /// @param beside at least what other threads of `own` have computed meanwhile
  void leave_out(Process& own, Duration computed, Duration beside);

  /// From ET `at`, with `used`, on. For tether-exec.
  void publish(ExecTime at, Duration used, double factor);
  ExecTime now() const;
  /// The same of who only looks, and fixes nothing.
  ExecTime glance() const;

  /// nullptr: there are too many waits.
  Wait* begin_wait(pid_t process, ExecTime deadline);
  static void end_wait(Wait* wait);
  /// The first deadline of all waits and timers; kNever: there is none. A wait that was told three
  /// times and goes on waits for more, such as a mutex: it is not among them.
  ExecTime first_deadline() const;
  /// Whether that process has one that is over and was not told since then. It is told now: by the
  /// machine's clock, that is `told_at`.
  bool tell_overdue(pid_t process, ExecTime now, Duration since, Duration told_at);

  const std::array<Process, kProcesses>& processes() const { return processes_; }
  /// Those that have been used so far.
  std::span<Thread> threads() { return {threads_.data(), threads_end_.load()}; }

 private:
  enum class Looks { kFixes, kGlances };
  Duration used_by_each(Looks looks) const;
  ExecTime course_at(Duration used) const;

  // Odd while something changes that is read together.
  std::atomic<std::uint32_t> moves_{0}, courses_{0};
  std::atomic<std::int64_t> ended_ns_{0}, left_out_ns_{0};
  std::atomic<ExecTime> base_et_{};
  std::atomic<std::int64_t> base_used_ns_{0};
  std::atomic<double> factor_{1.0};
  mutable std::atomic<ExecTime> latest_{};  // that anybody has seen
  mutable std::atomic<std::int64_t> latest_used_ns_{0};
  mutable std::array<Process, kProcesses> processes_;
  std::array<Wait, kWaits> waits_;
  std::array<Thread, kThreads> threads_;
  std::atomic<std::size_t> waits_end_{0}, threads_end_{0},
      processes_end_{0};  // behind the last one used so far

  static_assert(std::atomic<ExecTime>::is_always_lock_free);
};

struct UnmapGroupPage {
  void operator()(GroupPage* mapped) const;
};
using MappedGroupPage = std::unique_ptr<GroupPage, UnmapGroupPage>;
/// In a new file. Fails with kInvalid and the error of the system.
Result<MappedGroupPage> make_group_page(const std::string& file);
/// The same in another process. Fails also if it is the file of another version.
Result<MappedGroupPage> map_group_page(const std::string& file);

/// The clock of the group: `elapsed()` is used() × factor, all of it in children. `page` must
/// outlive it.
/// @param own this process; nullptr: it leaves out nothing
/// @param ended what processes have computed that have ended; nullptr: it knows no parts. It must
///   outlive the source.
std::unique_ptr<TimeSource> make_group_source(GroupPage& page, double factor,
                                              GroupPage::Process* own = nullptr,
                                              const Computed* ended = nullptr);

/// What tether-exec tells a process of a program that knows nothing of Tether: a Reply whose
/// sequence is one of these, on a connection of its own. The process answers each with a Progress.
/// In its Hello, the program is named so.
inline constexpr std::string_view kGroupEvents = "tether-events";
/// And so where the preloaded library calls for it, which has ET by itself.
inline constexpr std::string_view kGroupAgent = "tether-agent";
/// The file of the page, in the folder of tether-exec's socket.
std::string group_page_beside(std::string_view exec_socket);
enum class GroupEvent : std::uint64_t {
  kDue = 1,   ///< a deadline or a timer of it is over
  kMeasured,  ///< a sensor that wakes it has measured
  kMessage    ///< of the flight controller; the Reply has it
};

}  // namespace tether::client
