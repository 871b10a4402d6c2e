#pragma once

#include "controller_links.h"
#include "ends.h"
#include "peers.h"
#include "radio_traffic.h"
#include "run_log.h"
#include "sessions/looks.h"
#include "sessions/session.h"
#include "sessions/watchdog.h"
#include "stepper.h"
#include "time/real_time_limit.h"
#include "time/timelines.h"

#include <optional>
#include <string>
#include <vector>

#include <tether/coordinator/coordinator.h>

namespace tether::coordinator {

/// The loop of a run: receives messages of the SUTs (incoming.cpp), sends replies (outgoing.cpp),
/// passes messages between UAVs and to flight controllers (events.cpp), and advances ST in between
/// (coordinator.cpp). The decisions are made by its parts:
///
///     validator    whether a message of a SUT is allowed
///     Timelines    when a SUT sent a request, which replies are held until when, and how far ST
///                  may advance
///     RadioTraffic when a message between UAVs arrives, or why it is lost
///     ControllerLinks  when a flight controller steps, and its messages arrive
///     Stepper      what is due at each boundary; its Samplers: what sensors sample, and when
///     Watchdog     whether the run takes too long, and who is blocked on whom
///     ThreadLooks  what the threads of SUTs do meanwhile
///     RunLog       what the record has of all this, and in which order
///     Peers        who is connected
///     Ends         how the run ends
///
/// A request passes them in this order: it is validated; it may wait until its instant is known
/// (settle); it is planned (plan.cpp) and held by its Timeline; ST advances to its reply's
/// timestamp; release_ready sends the reply and logs the interaction. A message between UAVs that
/// arrives meanwhile can move a reply to an earlier instant (deliver).
class Coordinator::Impl {
 public:
  Impl(sim::Simulator& simulator, record::Recorder& recorder, RunOptions options,
       std::function<WallTime()> host_clock);

  RunReport run(link::Server& server, const RunHooks& hooks);

 private:
  // The loop.
  void turn();
  void start();
  std::vector<std::string> peers_of(const Session& session) const;
  record::Header make_header() const;
  bool advance();
  SimTime next_stop() const;
  void watch_flight();
  SimTime paced(SimTime target, WallTime now);
  void watch();
  bool awaits_only_confirmation(const Session& session) const;
  Party party(const Session& session, WallTime now) const;
  std::vector<Party> parties(WallTime now) const;
  void hear_emulated_start(Session& session, WallTime now);
  void end_endless(Session& session);
  void look_at_suts();
  void stop_if_asked();
  RunReport close_run();
  RunStatus status(WallTime now) const;

  // Incoming.
  void on_event(const link::Event& event);
  void on_message(link::PeerId peer, const link::Message& message);
  void on_closed(link::PeerId peer, const Failure& failure);
  void join(link::PeerId peer, const link::Hello& hello);
  void on_request(Session& session, const link::Request& request, WallTime now);
  void on_progress(Session& session, const link::Progress& progress, WallTime now);
  void on_annotation(Session& session, const link::Annotation& note);
  void on_refusal(Session& session, const link::Refusal& refusal);
  void check_replay(Session& session, const link::Request& request);
  void break_off(Session& session, link::Refusal::Reason reason, const Fault& fault);
  Standing standing(const Session& session) const;
  bool settle_boards();
  void begin(Sent sent);
  void refuse(link::PeerId peer, link::Refusal::Reason reason, const std::string& message) {
    peers_.refuse(peer, reason, message);
  }

  // Events.
  std::optional<sync::SutTime> next_event() const;
  SimTime next_event_step() const;
  void settle_events();
  void handle_radio();
  void deliver(Session& session, ExecTime arrived_at);
  void expel(Session& session, const Fault& fault);

  // Outgoing.
  void release_ready();
  void settle();
  void reply(Session& session, std::size_t open_index, SimTime st);
  void receive(const Session& session, PendingInteraction& pending, link::Reply& reply);
  void leave(Session& session);
  void computes_from(std::size_t uav, ExecTime at, WallTime since);

  Timeline& time_of(const Session& session) { return times_[session.uav]; }
  const Timeline& time_of(const Session& session) const { return times_[session.uav]; }
  const sim::World& world() const { return stepper_.world(); }
  const StepGrid& grid() const { return stepper_.grid(); }
  SimTime st() const { return stepper_.st(); }
  bool is_running() const { return began_.has_value(); }
  void end(Ending ending) { ends_.now(std::move(ending)); }

  const RunOptions options_;
  std::function<WallTime()> host_clock_;
  RunHooks hooks_;
  Peers peers_;
  RunLog log_;
  Timelines times_;
  Stepper stepper_;
  std::vector<Session> sessions_;  // one per UAV, in the world's order
  RadioTraffic radio_;
  ControllerLinks controllers_;
  std::optional<RealTimeLimit> pace_;
  std::optional<WallTime> began_;  // when every SUT had joined
  Watchdog watchdog_;
  ThreadLooks looks_;
  Ends ends_;
};

}  // namespace tether::coordinator
