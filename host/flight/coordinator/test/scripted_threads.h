#pragma once

#include <algorithm>
#include <functional>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include <tether/link/messages.h>

namespace tether::coordinator {

/// A step of a scripted SUT: computes for so long, then sends a request.
struct Act {
  Duration compute{0};
  std::variant<link::ReadSensor, link::SetVelocity, Duration /* sleep */, link::Finish,
               link::SendMessage, link::ReceiveMessage, link::ReadBattery, link::SetTrajectory>
      what;
};
using Script = std::vector<Act>;

/// The request for an act at ET `at`.
inline link::Request make_request(const Act& act, std::uint64_t sequence, ExecTime at) {
  link::Request request{.sequence = sequence, .issued_at = at, .body = {}};
  std::visit(
      [&](const auto& what) {
        if constexpr (std::is_same_v<std::decay_t<decltype(what)>, Duration>)
          request.body = link::Sleep{at + what};
        else
          request.body = what;
      },
      act.what);
  return request;
}

/// A concurrent SUT under its supervisor: each thread follows a script. All threads have one ET,
/// and are stopped `overshoot` after the first request or the time of the first reply.
class ScriptedThreads {
 public:
  using Deliver = std::function<void(link::Message)>;

  ScriptedThreads(std::vector<Script> scripts, Duration overshoot, Deliver deliver)
      : overshoot_(overshoot), deliver_(std::move(deliver)) {
    for (Script& script : scripts) threads_.push_back({.script = std::move(script)});
  }

  /// Takes a message of the coordinator.
  void on_message(const link::Message& message) {
    if (const auto* welcome = std::get_if<link::Welcome>(&message)) begin(*welcome);
    if (const auto* due = std::get_if<link::Due>(&message)) on_due(*due);
    if (const auto* reply = std::get_if<link::Reply>(&message)) on_reply(*reply);
    if (!free_running_ && stop_sent_ && may_resume()) resume();
  }

 private:
  struct Thread {
    Script script;
    std::size_t next = 0;
    ExecTime requests_at{};         // while it computes
    std::uint64_t sequence = 0;     // of its open call; 0: none
    std::optional<ExecTime> due{};  // when that one's reply is
    bool answered = false;

    bool computes() const { return sequence == 0 && next < script.size(); }
  };

  Thread* of(std::uint64_t sequence) {
    return &*std::find_if(threads_.begin(), threads_.end(),
                          [&](const Thread& t) { return t.sequence == sequence; });
  }

  void begin(const link::Welcome& welcome) {
    free_running_ = welcome.free_running;
    et_ = welcome.start;
    for (Thread& t : threads_) compute(t);
    if (!free_running_) return run_to_stop();
    for (Thread& t : threads_) ask(t, et_);
  }

  // A second one moves the reply up: if it is stopped after that already, it stays so and says so.
  void on_due(const link::Due& due) {
    Thread& t = *of(due.sequence);
    const bool stops_longer = t.due && stop_sent_ && due.reply_at <= et_;
    t.due = due.reply_at;
    ++dues_heard_;
    if (stops_longer) deliver_(stop());
  }
  link::Progress stop() const {
    return {.reached = et_, .stopped = true, .dues_heard = dues_heard_};
  }

  void on_reply(const link::Reply& reply) {
    Thread& t = *of(reply.sequence);
    t.answered = true;
    if (free_running_) {
      t.sequence = 0;
      ask(t, et_);
    }
  }

  void compute(Thread& t) {
    if (t.next < t.script.size()) t.requests_at = et_ + t.script[t.next].compute;
  }

  void ask(Thread& t, ExecTime at) {
    if (t.next == t.script.size()) return;
    t.sequence = ++last_sequence_;
    t.due.reset();
    t.answered = false;
    deliver_(make_request(t.script[t.next++], t.sequence, at));
  }

  // Runs until the first request or the time of the first reply, sends progress halfway, and stops.
  void run_to_stop() {
    ExecTime end = ExecTime::max();
    for (const Thread& t : threads_)
      if (t.computes()) end = std::min(end, t.requests_at);
    for (const Thread& t : threads_)
      if (t.sequence > 0) end = std::min(end, *t.due);
    if (end == ExecTime::max()) return;
    deliver_(link::Progress{et_ + (end - et_) / 2});
    et_ = end + overshoot_;

    std::vector<Thread*> asking;
    for (Thread& t : threads_)
      if (t.computes() && t.requests_at <= et_) asking.push_back(&t);
    std::stable_sort(asking.begin(), asking.end(), [](const Thread* a, const Thread* b) {
      return a->requests_at < b->requests_at;
    });
    for (Thread* t : asking) ask(*t, t->requests_at);
    deliver_(stop());
    stop_sent_ = true;
  }

  bool may_resume() const {
    return std::all_of(threads_.begin(), threads_.end(), [&](const Thread& t) {
      return t.sequence == 0 || t.answered || (t.due && *t.due > et_);
    });
  }

  void resume() {
    stop_sent_ = false;
    for (Thread& t : threads_) {
      if (!t.answered) continue;
      t.sequence = 0;
      t.answered = false;
      compute(t);
    }
    run_to_stop();
  }

  Duration overshoot_;
  Deliver deliver_;
  std::vector<Thread> threads_;
  bool free_running_ = false;
  bool stop_sent_ = false;  // the stop was delivered
  ExecTime et_;
  std::uint64_t last_sequence_ = 0;
  std::uint64_t dues_heard_ = 0;
};

}  // namespace tether::coordinator
