#pragma once

#include "callers.h"
#include "thread_files.h"

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <poll.h>
#include <sys/types.h>

#include <tether/client/exec/group_page.h>
#include <tether/client/vehicle.h>
#include <tether/supervisor/supervise.h>

namespace tether::supervisor {

/// The loop around the processes of one program that know nothing of Tether: one thread, on the one
/// core that they share. Each of them registers its waits in the page, and calls the UAV through
/// this process. A program on the client library may be among them: its calls are passed on, and a
/// read that has to wait for its measurement is one more thing for which ET goes on.
///
/// When all of them wait, it asks the coordinator for what comes first: a message of the flight
/// controller, a measurement, or the first deadline; ET goes on from there. It tells the processes
/// that wait for that, and waits until they have heard it: what they wake is at work then.
class AsIsSupervisor {
 public:
  /// What this process has besides the program.
  struct Own {
    const os::FileDescriptor& signals;  // a signalfd
    pid_t guardian;                     // a child
    client::Computed& computed;         // by processes that have ended
  };
  /// `program`: a child of this process. The references must outlive it.
  AsIsSupervisor(pid_t program, client::GroupPage& page, std::unique_ptr<client::Vehicle> vehicle,
                 double factor, Callers& callers, const Own& own, Say say);

  /// Until the program has ended. Its status as waitpid() gives it; none: the run is over.
  std::optional<int> run();
  /// The program has ended with this code.
  void finish(int exit_code);

 private:
  struct Pull {
    CallerId caller;
    std::uint64_t sequence;
  };
  using Body = decltype(link::Request::body);
  struct Read {
    CallerId caller;
    std::uint64_t sequence;
    link::ReadSensor what;
  };
  std::optional<int> reap();
  void take_signals();
  void forget_processes();
  void tell_if_idle();
  bool is_fed() const;
  std::vector<pollfd> ears() const;
  bool is_asked() const;
  void hear();
  void on_message(CallerId caller, link::Message message);
  void on_request(CallerId caller, link::Request request);
  void answer(CallerId caller, std::uint64_t sequence, Body body);
  void answer_reads();
  std::string reason_to_refuse(CallerId caller, const Body& body) const;
  void on_gone(CallerId caller);
  void tell(CallerId line, link::Reply event);
  void deliver(const std::vector<client::RadioMessage>& received);
  bool receive(Duration timeout);
  void pull();
  void pull_now_and_then();
  void wake_overdue();
  bool are_all_waiting();
  bool lead();
  void tell_if_woken(Duration used);
  void tell_if_shared(CallerId caller, std::uint32_t sensor);
  void doubt(const std::string& what);
  Duration slice();
  void publish();
  bool check(const Failure& failure);

  pid_t program_;
  client::GroupPage& page_;
  std::unique_ptr<client::Vehicle> vehicle_;
  double factor_;
  Callers& callers_;
  const os::FileDescriptor& signals_;
  ThreadFiles threads_;
  Say say_;
  std::map<CallerId, pid_t> lines_;  // to the processes, for what they wait for
  std::multiset<CallerId> unheard_;  // what they were told
  std::set<CallerId> agents_;        // who call for the preloaded library
  std::vector<Pull> pulls_;          // to be answered when all have heard
  struct Readers {
    CallerId last = 0;
    std::set<CallerId> all;
    bool are_told = false;
  };
  std::map<std::uint32_t, Readers> readers_;  // of each sensor
  std::vector<Read> reads_;                   // to be answered when there is a measurement
  client::Computed& computed_;                // by processes that have ended
  bool is_over_ = false, is_known_to_be_used_ = false;
  int wakes_ = 0;  // from outside
  int interrupts_ = 0;
  bool is_pulling_ = false;
  Duration patience_{0}, forgotten_at_{0};
  ExecTime glanced_{Duration(-1)};
  ExecTime pulled_at_{};
};

}  // namespace tether::supervisor
