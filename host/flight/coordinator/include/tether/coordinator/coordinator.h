#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <tether/autopilot/flight_controller.h>
#include <tether/base/time.h>
#include <tether/computer/clock.h>
#include <tether/link/messages.h>
#include <tether/link/server.h>
#include <tether/radio/settings.h>
#include <tether/record/messages.h>
#include <tether/record/writer.h>
#include <tether/sim/simulator.h>
#include <tether/sync/barrier_synchronizer.h>
#include <tether/uav/sensor_timing.h>
#include <tether/uav/setpoint.h>

/// The part between the simulator and the SUTs (paper, Section II and Fig. 2). It keeps the
/// sessions of the SUTs, applies the timing of sensors and the decisions of the barrier, and writes
/// the record.
namespace tether::coordinator {

/// Gives one SUT its time, by stage, with the clock "replayed". What it gives depends on the calls
/// so far only. Not thread-safe; used by the thread of Coordinator::run.
class GivenTime {
 public:
  virtual ~GivenTime() = default;

  /// What is different between this program and the one whose time it is; none: nothing. Called
  /// before the SUT is welcomed.
  virtual std::optional<std::string> other_build(const link::Hello& hello) const = 0;
  /// What each stage takes until the next call.
  virtual std::vector<link::StageTime> given() const = 0;
  /// Takes the next call of the SUT: a kind of record::Interaction, or the name of a sensor; and
  /// the stages before it. The difference to what was given, which ends the run; none if there is
  /// none.
  virtual std::optional<std::string> take(const std::string& call,
                                          const std::vector<link::StageTime>& stages) = 0;
  /// Whether the time of that stage is known.
  virtual bool knows(const std::string& stage) const = 0;
};

/// The flight controller of a UAV, and its link to the SUT.
struct ControllerOptions {
  std::string name;      ///< for the record
  std::string estimate;  ///< what it flies on, for the record: a sensor, or "truth"
  std::function<std::unique_ptr<autopilot::FlightController>()> make;
  Duration period{0};        ///< of its steps; > 0, a multiple of the simulator's
  double link_baud = 0.0;    ///< 0: bytes take no time
  Duration link_latency{0};  ///< each way; >= 0
  /// It answers in the same way in each run. What the user brings may not: load and clocks of the
  /// machine are among what it tells.
  bool repeats = true;
};

/// One UAV of the world and its SUT.
struct UavOptions {
  std::vector<uav::SensorTiming> timings;  ///< one per sensor of the UAV, in the world's order
  uav::Delay command_latency{};            ///< from a command's timestamp to its effect
  /// The clock by which the condition measures this SUT's time. A SUT with another clock is
  /// rejected. None: any clock.
  std::optional<computer::Clock> clock{};
  /// Cores of the SUT's machine; they limit how fast its CPU time can grow. 0: not known.
  int cores = 0;
  /// With the clock "replayed": makes what gives the SUT its time, from where `replayed_from` says.
  std::function<std::unique_ptr<GivenTime>()> given_time{};
  std::optional<record::ReplayInfo> replayed_from{};
  /// Index in RunOptions::boards of the computer that its SUT shares with others; none: it has one
  /// of its own. The clock must then be given: kWall on a real one, otherwise kCpu, kScripted,
  /// kCounted or kReplayed.
  std::optional<std::size_t> board{};
  std::string computer{};  ///< where its SUT runs, for messages; empty: all run on the same
  std::string launcher{};  ///< words before its command, for the record
  /// The core on which it runs; then only pinned programs run there.
  std::optional<int> pinned_core{};
  std::optional<uav::SetpointLoss> setpoint_loss{};  ///< none: it keeps the last set-point
  /// None: commands of the SUT are those of the vehicle's own loops.
  std::optional<ControllerOptions> controller{};
  bool as_is = false;  ///< its SUT is a program as it is, for the record
};

/// A computer with several programs, which share its cores: a virtual one (sync::SharedCores), or
/// a real one, on which they run and are stopped as one group (tether-exec).
struct Board {
  std::string name;
  int cores = 1;         ///< ≥ 1; of a real one 0
  bool is_real = false;  ///< only concurrent SUTs are accepted on it, unless in free running
};

struct RunOptions {
  sync::SyncPolicy policy = sync::SyncPolicy::kConservativeBarrier;
  std::vector<UavOptions> uavs;   ///< one per UAV of the world, in its order
  std::vector<Board> boards;      ///< free running ignores them
  std::string token;              ///< every SUT must send it; not empty
  std::uint64_t seed = 0;         ///< of noise and delays
  double real_time_factor = 0.0;  ///< limit on ST per WT; 0: none. Free running needs one
  Duration time_limit = std::chrono::minutes(10);     ///< of ST; > 0
  Duration connect_limit = std::chrono::seconds(30);  ///< of WT until every SUT has joined
  Duration hang_limit =
      std::chrono::seconds(30);  ///< of WT without a message from a SUT that computes
  Duration ground_truth_period = std::chrono::milliseconds(10);  ///< of ST; > 0
  bool record_images = false;                                    ///< those that a SUT has read
  Duration image_period{0};  ///< least ST between two recorded images of one camera; 0: every one
  radio::Settings radio{};   ///< between the UAVs
  record::Header header;  ///< filled in by the caller; the coordinator adds policy, timing and SUTs
};

/// Why a run ended.
enum class RunEnd {
  kFinished,       ///< every SUT has finished
  kTimeLimit,      ///< ST reached the limit first
  kSutLost,        ///< a SUT disconnected, broke the protocol, or never joined
  kSutHung,        ///< no message from a SUT within the limit
  kSimulatorLost,  ///< the simulator failed
  kInterrupted,    ///< `should_stop` of the caller requested it
  kBatteryEmpty,   ///< the battery of a UAV was exhausted, and it fell
  kRecordFailed,   ///< the record could not be written; it has no end
  kTimingDiffers,  ///< a call or a stage of a SUT is not the one whose time is replayed
  kFlooded,        ///< a SUT sent too many messages by radio; the others have finished since
  kKilled,         ///< `killed` of the caller found a reason in the flight
};
std::string_view name(RunEnd end);

/// The end of a run, for people too.
struct Ending {
  RunEnd how = RunEnd::kFinished;
  std::string reason;      ///< one line; names the cause
  std::string seen{};      ///< of a cause that the coordinator does not know: how it noticed
  std::string lost_uav{};  ///< whose SUT disconnected; empty: none did
};

/// What the threads of a SUT do at one instant.
struct ThreadStates {
  int runnable = 0;         ///< run, or wait for a core
  bool is_halted = false;   ///< one is stopped by a debugger or a signal
  bool is_on_disk = false;  ///< one waits for the disk
  /// A thread of the client library runs or waits for a core: the others may wait for it alone.
  bool is_served = false;
};

/// What the threads of a SUT did while it should have computed: each look counts for the WT until
/// the next one. Waiting that is an interaction is not part of it.
struct SutLooks {
  Duration waiting{0};         ///< none was runnable, halted, or on the disk
  Duration on_disk{0};         ///< none was runnable or halted, and one on the disk
  Duration computing{0};       ///< some were runnable
  Duration of_all_threads{0};  ///< the same, added up over them
  int parallel_looks = 0;      ///< of these, looks that found several

  /// Adds a look that counts for so long.
  void add(const ThreadStates& states, Duration represented);
};

/// The result of one SUT.
struct SutReport {
  std::string uav;
  std::string sut;                     ///< its name from the Hello, printable; empty: never joined
  std::optional<link::Finish> finish;  ///< its own report; the outcome is printable
  ExecTime et;                         ///< its ET at the end of the run
  SutLooks looks{};  ///< under the barrier, unless its clock counts all waiting as it is
  /// Sensors from whose queues it read, and how many measurements had no place there. In free
  /// running, none waits: how many would have waited.
  std::vector<std::pair<std::string, std::uint64_t>> unqueued{};
};

struct RunReport {
  RunEnd end = RunEnd::kFinished;
  std::string reason;  ///< one line; names the cause
  /// Where in it another cause belongs: before ": " and how the coordinator noticed, or at its end.
  std::size_t causes_at = 0;
  SimTime st;          ///< at the end
  bool began = false;  ///< whether every SUT has joined
  Duration wall{0};    ///< since then
  std::uint64_t interactions = 0;
  std::uint64_t images = 0;  ///< rendered because a SUT read them
  std::uint64_t causality_violations = 0;
  Duration largest_lag{0};
  Duration largest_grid_error{0};
  std::uint64_t stops = 0;        ///< of concurrent SUTs
  Duration largest_overshoot{0};  ///< of a stop beyond the timestamp of its reply
  std::vector<SutReport> suts;    ///< in the world's order of UAVs
  std::string lost_uav{};         ///< as in Ending
};

/// Progress of a run, for display.
struct RunStatus {
  std::size_t joined = 0;  ///< SUTs
  SimTime st;
  std::optional<ExecTime> et;  ///< greatest of all SUTs; none in free running
  Duration wall{0};
  std::uint64_t interactions = 0;
  std::uint64_t images = 0;
  std::string waiting_for;  ///< name of the UAV whose SUT blocks ST; empty: none
  /// If nothing has moved for a second: which SUT blocks the run, or which has not joined; else
  /// empty.
  std::string blocked;
};

/// Callbacks of a run, called from `run`; the first two some tens of times per second of WT.
struct RunHooks {
  /// A reason to end the run now, for example an interrupt or a SUT's process that died. None:
  /// continue.
  std::function<std::optional<Ending>()> should_stop;
  std::function<void(const RunStatus&)> on_status;
  /// Why the flight must end, and since when: at an instant of a message that was recorded since
  /// the last call. Must depend on recorded messages only: the run then always ends at the same ST,
  /// some steps later. Called after each advance of ST.
  std::function<std::optional<std::pair<SimTime, std::string>>()> killed;
  /// A connection was rejected, with the reason in one line.
  std::function<void(const std::string& address, const std::string& reason)> on_refused;
  /// With clocks "counted": how long the SUT of that UAV has computed so far, in ET, and what the
  /// library in it has. As long as it grows, the SUT is not hung, and may take longer to join.
  std::function<Duration(std::size_t uav)> computed_by;
  /// A SUT has joined: from where, and its process as it numbers it (0: not known).
  std::function<void(std::size_t uav, const std::string& address, std::uint32_t process)> on_joined;
  /// What the threads of that SUT do now; none: not known. Called some hundred times per second of
  /// WT, while a SUT computes whose ET is not the time that passes.
  std::function<std::optional<ThreadStates>(std::size_t uav)> threads_of;
  /// Reads the state of the SUTs' machine for the record. Called once after a run that had begun,
  /// when its SUTs have been notified of the end.
  std::function<record::Readings()> read_target;
};

/// One run. Construct, call `run` once.
///
/// Not thread-safe. One loop on the caller's thread handles messages, makes decisions and steps the
/// simulator, so the order of events is deterministic. `host_clock` is read for the record, for
/// limits of WT and for pacing; no decision of the barrier depends on it.
class Coordinator {
 public:
  /// `simulator` and `recorder` must outlive the coordinator.
  /// @throws Error(kInternal) if the options do not fit the simulator's world.
  Coordinator(sim::Simulator& simulator, record::Recorder& recorder, RunOptions options,
              std::function<WallTime()> host_clock);
  ~Coordinator();
  Coordinator(const Coordinator&) = delete;
  Coordinator& operator=(const Coordinator&) = delete;

  /// Waits for the SUT of every UAV, runs until the end, notifies the SUTs, and writes the record's
  /// footer. A failed run is a report, too, also if the record cannot be written. If every SUT's
  /// clock is scripted, counted or replayed, the record is the same to the byte in each run:
  /// without wall times, readings of the target, and the machine; the report and the caller have
  /// them.
  RunReport run(link::Server& server, const RunHooks& hooks = {});

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tether::coordinator
