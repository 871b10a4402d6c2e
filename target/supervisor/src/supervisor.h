#pragma once

#include "freezer.h"
#include "group.h"
#include "guardian.h"
#include "member.h"
#include "membership.h"
#include "statistics.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <poll.h>
#include <sys/types.h>

#include <tether/client/exec/clock_page.h>
#include <tether/supervisor/supervise.h>

namespace tether::supervisor {

/// What is around the commands; it outlives them.
struct Surroundings {
  std::string folder;  ///< private
  std::optional<Cgroup> cgroup;
  Guardian& guardian;
  os::FileDescriptor signals;  ///< a signalfd of SIGCHLD, SIGINT, SIGTERM and SIGHUP
  std::unique_ptr<Freezer> freezer;
  client::SharedClockPage clock;
};

/// The loop around Group: one thread that waits for the commands' threads, the coordinator, signals
/// and the next instant at which the commands must be stopped.
class Supervisor {
 public:
  Supervisor(const Settings& settings, Surroundings& surroundings, Say say);

  /// Starts the program whose command the settings have. Fails with kInvalid.
  Status start();
  /// Gets the commands of the members, as many as the settings say, from this socket.
  void listen(os::FileDescriptor listener) { listener_ = std::move(listener); }

  /// Until all commands have ended. Returns the exit code of the program that `start` started, 128
  /// + signal if one ended it, or else 0; 3 if a command could not be stopped: all of them have
  /// been killed then.
  int run();
  std::string statistics() const;

 private:
  // Members.
  Status add(Program& program, os::FileDescriptor& starter);
  void hear_starters();
  bool take_program(os::FileDescriptor& starter);
  void hear_starter(Member& member);
  bool is_complete() const { return members_.size() + failed_to_start_ >= expected_; }
  bool have_all_ended() const;

  // Waiting.
  void wait();
  std::optional<Duration> next_wake() const;
  void take_signals();
  void reap();

  // Stopping and going on.
  bool must_hold(Duration now) const;
  void begin();
  void hold_while_joining();
  void stop_if_due();
  void stop();
  void give_up(const Failure& failure);
  void go_on();
  void report_progress();
  bool runs() const { return !held_ && group_.is_running(); }

  const Settings& settings_;
  Surroundings& around_;
  Say say_;
  std::size_t expected_;
  std::size_t failed_to_start_ = 0;

  os::FileDescriptor listener_;               // for members' processes
  std::vector<os::FileDescriptor> starters_;  // whose program has not arrived yet
  std::vector<std::unique_ptr<Member>> members_;
  Group group_;
  bool held_ = false;       // stopped for joining
  bool has_begun_ = false;  // ET advances
  Duration progress_period_{0};
  Duration next_progress_{0};    // on the monotonic clock
  bool failed_ = false;          // a command could not be stopped
  std::vector<pollfd> entries_;  // as the last wait left them
  std::string priority_;
  Statistics statistics_;
};

}  // namespace tether::supervisor
