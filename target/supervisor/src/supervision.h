#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include <tether/base/result.h>
#include <tether/base/time.h>
#include <tether/link/messages.h>

namespace tether::supervisor {

/// One connection of a program under supervision; it has one call open at a time.
using CallerId = std::uint64_t;

/// To be handed to a caller. No message: hang up.
struct Answer {
  CallerId caller = 0;
  std::optional<link::Message> message;
};

/// What a group of programs and its coordinator say to each other, and when the group may run: pure
/// logic, no socket, process or clock.
///
/// Under the barrier the group runs, is stopped, runs again:
///
///   running  ── must_stop(now) ──►  freeze, read ET, drain the callers' sockets: stopped(at)
///   stopped  ── may_go_on()    ──►  go_on(), hand out take_answers(), thaw
///
/// It stops for every request, so that no thread computes past the instant at which it may have to
/// wait for another's reply; and when ET has reached the instant at which a reply is due, until the
/// reply is there. What take_outgoing() gives goes to the coordinator in that order, at once.
///
/// In free running the group never stops; requests, replies and progress pass through.
class Supervision {
 public:
  Supervision(bool free_running, ExecTime start);

  /// A call begins. Its request reaches the coordinator with the next stop.
  void asked(CallerId caller, link::Request request);
  /// The caller has hung up: what it asked for stays due, and its reply is dropped.
  void gone(CallerId caller);
  void annotated(link::Annotation annotation);

  /// From the coordinator. Fails with kProtocol if it answers nothing that was asked, or with times
  /// that cannot be; nothing has changed then.
  Status heard(const link::Due& due);
  Status heard(link::Reply reply);
  /// There is no coordinator any more. Calls whose reply is there and due get it. All other open
  /// calls and all later ones get the refusal or, without one, are hung up on; if a finish was
  /// among the replies, they hear that the run has ended. The group runs.
  void end(std::optional<link::Refusal> why);

  bool is_running() const { return running_; }
  bool is_over() const { return over_; }
  /// A thread has finished the mission, and the coordinator has confirmed it.
  bool is_finished() const { return finished_; }
  /// @pre is_running()
  bool must_stop(ExecTime now) const;
  /// The next instant at which the group must stop, as far as known.
  std::optional<ExecTime> stop_at() const;
  /// Whether a reply is due at this very instant, and not there yet.
  bool awaits_reply_at(ExecTime t) const;
  /// All threads are stopped since `at`, and their earlier requests were passed on. Or they have
  /// been stopped, and `at`, which is later, counts.
  void stopped(ExecTime at);
  /// @pre !is_running()
  bool may_go_on() const;
  /// The group continues; ET continues from `stopped_at`. @pre may_go_on()
  void go_on();
  ExecTime stopped_at() const { return stopped_at_; }

  /// Reports the ET reached so far with a Progress. Does nothing while stopped.
  void progressed(ExecTime now);

  std::vector<link::Message> take_outgoing();
  /// Under the barrier, replies only while the group is stopped.
  std::vector<Answer> take_answers();

 private:
  struct Asked {
    CallerId caller;
    link::Request request;
  };
  struct Open {
    CallerId caller = 0;  // 0: gone
    std::uint64_t callers_sequence = 0;
    ExecTime issued_at;
    bool finishes = false;
    bool receives = false;  // a message may make its reply due earlier
    std::optional<ExecTime> due;
    std::optional<link::Reply> reply;
  };

  link::Progress stop_message() const;
  void forward(Asked asked, ExecTime latest);
  void hand_out(Open open);
  void hand_out_what_is_there();
  void refuse(CallerId caller);

  bool free_running_;
  bool running_ = true;
  bool over_ = false;
  bool finished_ = false;
  std::optional<link::Refusal> why_over_;
  ExecTime stopped_at_;
  ExecTime last_sent_;          // no later stamp or Progress is before it
  std::uint64_t sequence_ = 0;  // of the last request sent
  std::uint64_t dues_heard_ = 0;
  std::vector<Asked> asked_;            // not yet sent
  std::map<std::uint64_t, Open> open_;  // by sequence
  std::vector<link::Message> outgoing_;
  std::vector<Answer> answers_;
};

}  // namespace tether::supervisor
