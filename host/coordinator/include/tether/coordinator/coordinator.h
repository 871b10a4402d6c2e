#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tether/base/time.h>
#include <tether/link/server.h>
#include <tether/record/messages.h>
#include <tether/record/writer.h>
#include <tether/sim/simulator.h>
#include <tether/sync/barrier_synchronizer.h>
#include <tether/uav/sensor_timing.h>

/// The program between simulator and SUTs (paper, Section II and Fig. 2): sessions, sensor timing,
/// the barrier's decisions carried out, and the record of it all.
namespace tether::coordinator {

struct ClockSetting {
  link::ClockKind kind = link::ClockKind::kWall;
  double cpu_factor = 1.0;  ///< of link::ClockKind::kCpu and kWall: seconds of ET per second of it
  Duration computing{0};    ///< of link::ClockKind::kScripted: for each phase of computing
};

/// How one UAV of the world meets its SUT.
struct UavOptions {
  std::vector<uav::SensorTiming> timings;  ///< one per sensor of the UAV, in the world's order
  Duration command_latency{0};             ///< from a command's stamp to its effect; ≥ 0
  /// How the condition measures this SUT's time. One that measures otherwise is refused; scripted
  /// and unstamped ones are let in, and the record names them. None: any.
  std::optional<ClockSetting> clock{};
  /// Of the machine that its SUT runs on: how far its CPU time is believed. 0: not known.
  int cores = 0;
};

struct RunOptions {
  sync::SyncPolicy policy = sync::SyncPolicy::kConservativeBarrier;
  std::vector<UavOptions>
      uavs;                ///< one per UAV of the world, in its order; each is flown by one SUT
  std::string token;       ///< without it nobody is let in; not empty
  std::uint64_t seed = 0;  ///< of noise and delays
  double real_time_factor = 0.0;  ///< limit on ST per WT; 0: none. Free running needs one
  Duration time_limit = std::chrono::minutes(10);     ///< of ST; > 0
  Duration connect_limit = std::chrono::seconds(30);  ///< of WT until every SUT has joined
  Duration hang_limit =
      std::chrono::seconds(30);  ///< of WT without a word from a SUT that computes
  Duration ground_truth_period = std::chrono::milliseconds(10);  ///< of ST; > 0
  bool record_images = false;                                    ///< those that a SUT consumed
  Duration image_period{0};  ///< least ST between two recorded images of one camera; 0: every one
  record::Header header;  ///< what the caller knows; the coordinator adds policy, timing and SUTs
};

/// Why a run ended.
enum class RunEnd {
  kFinished,       ///< every SUT said that it is done
  kTimeLimit,      ///< ST reached the limit first
  kSutLost,        ///< a SUT disconnected, broke the protocol, or never joined
  kSutHung,        ///< a SUT gave no word for longer than its limit
  kSimulatorLost,  ///< the simulator failed
  kInterrupted,    ///< the caller's `should_stop` said so
};
std::string_view name(RunEnd end);

/// What one SUT left behind.
struct SutReport {
  std::string uav;
  std::string sut;                     ///< the name it gave, printable; empty: never joined
  std::optional<link::Finish> finish;  ///< what it said at its end; the outcome printable
  ExecTime et;                         ///< its ET at the end of the run
};

struct RunReport {
  RunEnd end = RunEnd::kFinished;
  std::string reason;  ///< one line; names the culprit
  SimTime st;          ///< at the end
  bool began = false;  ///< every SUT had joined
  Duration wall{0};    ///< from that moment on
  std::uint64_t interactions = 0;
  std::uint64_t images = 0;  ///< rendered because a SUT read them
  std::uint64_t causality_violations = 0;
  Duration largest_lag{0};
  Duration largest_grid_error{0};
  std::uint64_t stops = 0;        ///< of concurrent SUTs, in which all of one stood still
  Duration largest_overshoot{0};  ///< by how much one of them came after the reply for which it was
  std::vector<SutReport> suts;    ///< in the world's order of UAVs
};

/// What is going on, for a person who watches.
struct RunStatus {
  std::size_t joined = 0;  ///< SUTs
  SimTime st;
  std::optional<ExecTime> et;  ///< greatest of all SUTs; none where it is not tied to ST
  Duration wall{0};
  std::uint64_t interactions = 0;
  std::uint64_t images = 0;
  std::string waiting_for;  ///< the SUT that ST waits for; empty: none
  /// Nothing has moved for a second: who blocks whom, or whose SUT has not joined; else empty.
  std::string blocked;
};

/// What the caller has a say in while a run goes on. Called from `run`; the first two some tens of
/// times per second of WT.
struct RunHooks {
  /// A reason to end the run now (the user's interrupt, a SUT's process that died); empty: go on.
  std::function<std::optional<std::pair<RunEnd, std::string>>()> should_stop;
  std::function<void(const RunStatus&)> on_status;
  /// Somebody was not let in, or sent what no SUT sends: whence, and why. One line.
  std::function<void(const std::string&)> on_refused;
  /// Once, when a run that had begun has ended and its SUTs have been told: how the machine that
  /// they ran on is doing, for the record.
  std::function<record::Readings()> read_target;
};

/// One run. Construct, call `run` once.
///
/// Everything happens on the caller's thread: messages are handled, decisions taken and steps made
/// in one loop, so that there is nothing to lock and no order left to chance. `host_clock` is read
/// for the record, for limits of WT and for pacing; no decision of the barrier depends on it.
class Coordinator {
 public:
  /// `simulator` and `recorder` must outlive the coordinator.
  /// @throws Error(kInternal) if the options do not fit the simulator's world.
  Coordinator(sim::Simulator& simulator, record::Recorder& recorder, RunOptions options,
              std::function<WallTime()> host_clock);
  ~Coordinator();
  Coordinator(const Coordinator&) = delete;
  Coordinator& operator=(const Coordinator&) = delete;

  /// Waits for every UAV's SUT, runs until the end, tells the SUTs, and writes the record's footer.
  /// Every way in which a run can fail is in the report. @throws Error(kSetup) only when the record
  /// cannot be written.
  RunReport run(link::Server& server, const RunHooks& hooks = {});

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tether::coordinator
