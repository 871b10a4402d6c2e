#pragma once

#include "callers.h"
#include "freezer.h"
#include "joining.h"
#include "statistics.h"
#include "supervision.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <poll.h>
#include <sys/types.h>

#include <tether/client/exec/clock_page.h>
#include <tether/supervisor/settings.h>
#include <tether/supervisor/supervise.h>

namespace tether::supervisor {

/// The loop around Supervision: one thread that waits for the command's threads, the coordinator,
/// signals and the next instant at which the command must be stopped.
class Supervisor {
 public:
  /// `signals` is a signalfd of SIGCHLD, SIGINT, SIGTERM and SIGHUP.
  Supervisor(const Settings& settings, pid_t command, client::SharedClockPage clock,
             os::FileDescriptor listener, os::FileDescriptor signals,
             std::unique_ptr<Freezer> freezer, Say say);

  /// Until the command ends. Returns its exit code, 128 + signal if one ended it, or 3 if it could
  /// not be stopped; then it has been killed.
  int run();
  std::string statistics() const;

 private:
  // Waiting.
  void wait();
  std::optional<Duration> next_wake() const;
  void take_signals();
  void reap();
  void interrupt(int signal);
  void check_interrupt();

  // The callers.
  void hear_callers();
  void on_message(CallerId caller, link::Message message);
  void on_hello(CallerId caller, const link::Hello& hello);
  void hand_out_answers();
  Callers::Events caller_events();

  // The coordinator.
  void connect(const link::Hello& hello);
  void hear_coordinator();
  void on_message(link::Message message);
  void on_welcome(link::Welcome welcome);
  void send_outgoing();
  void lose_coordinator(const Failure& failure);
  void refuse_all(link::Refusal refusal);

  // Stopping and going on.
  void hold_while_joining();
  void stop_if_due();
  void stop();
  void give_up(const Failure& failure);
  void go_on();
  void report_progress();
  bool group_runs() const { return !held_ && (!supervision_ || supervision_->is_running()); }

  const Settings& settings_;
  pid_t command_;
  client::SharedClockPage clock_;
  os::FileDescriptor signals_;
  std::unique_ptr<Freezer> freezer_;
  Callers callers_;
  Say say_;

  std::unique_ptr<link::Channel> channel_;  // to the coordinator, from the first Hello on
  std::vector<CallerId> waiting_;           // for the Welcome
  Joining joining_;
  bool held_ = false;  // stopped for joining
  std::optional<link::Welcome> welcome_;
  std::optional<link::Refusal> refusal_;    // no Welcome will come any more
  std::optional<Supervision> supervision_;  // from the Welcome on
  Duration progress_period_{0};
  Duration next_progress_{0};  // on the monotonic clock, as what follows

  std::optional<Duration> interrupted_at_;
  std::optional<int> exit_code_;  // of the command
  bool failed_ = false;           // it could not be stopped
  std::vector<pollfd> entries_;   // as the last wait left them
  Statistics statistics_;
};

}  // namespace tether::supervisor
