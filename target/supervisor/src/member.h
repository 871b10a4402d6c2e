#pragma once

#include "callers.h"
#include "joining.h"
#include "supervision.h"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <poll.h>
#include <sys/types.h>

#include <tether/client/exec/clock_page.h>
#include <tether/supervisor/supervise.h>

namespace tether::supervisor {

/// A command that has been started.
struct Started {
  std::string uav;               ///< empty: the one that the program names, or the only one
  pid_t process = 0;             ///< also its process group
  os::FileDescriptor listener;   ///< for its threads and processes
  os::FileDescriptor errors{};   ///< where to write what concerns it; empty: use `say`
  os::FileDescriptor starter{};  ///< to the process that gave it (membership.h); empty: none did
};

/// One program of the group: its threads and processes on one side, its session with the
/// coordinator on the other, Supervision in between.
class Member {
 public:
  /// The references must outlive it.
  Member(const Settings& settings, Started command, const client::SharedClockPage& clock, Say say);

  const std::string& uav() const { return uav_; }
  pid_t process() const { return process_; }
  /// −1: there is none.
  int starter() const { return starter_.get(); }

  /// From the Welcome on.
  Supervision* supervision() { return supervision_ ? &*supervision_ : nullptr; }
  const link::Welcome& welcome() const { return *welcome_; }
  /// Of ET, per second of this machine. @pre as welcome()
  double clock_rate() const {
    return welcome_->free_running ? welcome_->real_time_factor : settings_.factor;
  }
  const Joining& joining() const { return joining_; }

  /// Adds the descriptors to poll; `runs`: the group does. While it is stopped, it sends nothing.
  void add_to(std::vector<pollfd>& entries, bool runs) const;
  void hear_coordinator(const std::vector<pollfd>& entries);
  void hear_callers(const std::vector<pollfd>& entries);
  void hear_all_callers();
  void send_outgoing();
  void hand_out_answers();

  /// The coordinator is not heard any more. All open and later calls get the refusal.
  void refuse_all(link::Refusal refusal);
  /// The command has ended: so has its session.
  void ended(int code, const std::string& message = "");
  std::optional<int> exit_code() const { return exit_code_; }

  /// Passes a signal on to the command; it is killed some time later, or at the next one.
  void interrupt(int signal);
  std::optional<Duration> next_wake(Duration now) const;
  /// The command hears the signal when it runs next: as soon as the coordinator lets it or, if that
  /// takes half of its time, without. `runs`: the group does.
  void check_interrupt(Duration now, bool runs);
  void kill() const;

 private:
  Callers::Events caller_events();
  void on_message(CallerId caller, link::Message message);
  void on_hello(CallerId caller, const link::Hello& hello);
  void refuse(CallerId caller, const link::Refusal& why);
  void connect(const link::Hello& hello);
  void on_message(link::Message message);
  void on_welcome(link::Welcome welcome);
  Status on_reply(link::Reply reply);
  void lose_coordinator(const Failure& failure);

  const Settings& settings_;
  const client::SharedClockPage& clock_;
  std::string uav_;
  pid_t process_;
  Callers callers_;
  os::FileDescriptor errors_;
  os::FileDescriptor starter_;
  Say say_;

  std::unique_ptr<link::Channel> channel_;  // to the coordinator, from the first Hello on
  std::vector<CallerId> waiting_;           // for the Welcome
  Joining joining_;
  std::optional<link::Welcome> welcome_;
  std::optional<link::Refusal> refusal_;    // no Welcome will come any more
  std::optional<Supervision> supervision_;  // from the Welcome on
  std::optional<Duration> interrupted_at_;
  std::optional<int> exit_code_;  // of the command
};

}  // namespace tether::supervisor
