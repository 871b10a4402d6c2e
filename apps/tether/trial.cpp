#include "trial.h"

#include "child_process.h"
#include "interrupt.h"
#include "machine.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <memory>
#include <vector>

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/file.h>
#include <unistd.h>

#include <tether/audit/audit.h>
#include <tether/base/error.h>
#include <tether/base/version.h>
#include <tether/record/reader.h>
#include <tether/record/writer.h>
#include <tether/sim_mujoco/mujoco_simulator.h>

namespace tether::app {

namespace {

using coordinator::RunEnd;

constexpr Duration kHelloTimeout = std::chrono::seconds(5);
// How long a SUT that has finished may take to leave.
constexpr Duration kLeaveLimit = std::chrono::seconds(2);

WallTime host_now() {
  return WallTime(
      std::chrono::duration_cast<Duration>(std::chrono::steady_clock::now().time_since_epoch()));
}

std::string token_of_run() {
  const char* given = std::getenv("TETHER_TOKEN");
  return given && *given ? given : link::make_token();
}

/// The SUT's program with its parameters as options: max_frames = 5 becomes --max-frames 5.
std::vector<std::string> command_line(const scenario::Sut& sut) {
  std::vector<std::string> words = sut.command;
  for (const auto& [key, value] : sut.parameters) {
    std::string option = "--" + key;
    std::replace(option.begin(), option.end(), '_', '-');
    words.push_back(option);
    words.push_back(value);
  }
  return words;
}

std::string clock_setting(const scenario::Condition& condition) {
  return condition.clock == scenario::Clock::kWall ? "wall"
                                                   : fmt::format("cpu*{}", condition.cpu_factor);
}

coordinator::RunOptions run_options(const TrialSpec& spec, const sim::World& world,
                                    const std::string& token) {
  coordinator::RunOptions options;
  options.policy = spec.condition.policy == scenario::Policy::kFreeRunning
                       ? sync::SyncPolicy::kFreeRunning
                       : sync::SyncPolicy::kConservativeBarrier;
  const auto timings = scenario::resolve_timings(spec.scenario, world);
  const coordinator::ClockSetting clock{spec.condition.clock == scenario::Clock::kWall
                                            ? link::ClockKind::kWall
                                            : link::ClockKind::kCpu,
                                        spec.condition.cpu_factor};
  for (std::size_t i = 0; i < timings.size(); ++i)
    options.uavs.push_back({timings[i], spec.scenario.uavs[i].command_latency, clock});
  options.token = token;
  options.seed = spec.seed;
  options.real_time_factor = spec.condition.real_time_factor;
  options.time_limit = spec.scenario.time_limit;
  options.hang_limit = spec.scenario.hang_limit;
  if (spec.external_sut) options.connect_limit = std::chrono::hours(24);
  options.ground_truth_period = spec.scenario.ground_truth_period;
  options.record_images = spec.scenario.record_images;
  options.header.tether_version = version();
  options.header.scenario = spec.scenario.name;
  options.header.condition = spec.condition.name;
  options.header.machine = describe_machine();
  return options;
}

/// The scenario's SUTs as processes of this machine, or none where the user starts them.
class Suts {
 public:
  struct Sut {
    std::string uav;
    std::filesystem::path log;
    std::unique_ptr<ChildProcess> process;
  };

  void start(const TrialSpec& spec, const std::string& address, const std::string& token) {
    for (const scenario::UavSetup& uav : spec.scenario.uavs) {
      const std::string& name = uav.placement.name;
      ChildCommand command{.arguments = command_line(uav.sut),
                           .environment = {{"TETHER_ADDRESS", address},
                                           {"TETHER_TOKEN", token},
                                           {"TETHER_UAV", name},
                                           {"TETHER_CLOCK", clock_setting(spec.condition)}},
                           .log = spec.folder / fmt::format("sut-{}.log", name)};
      suts_.push_back({name, command.log, std::make_unique<ChildProcess>(command)});
    }
  }

  /// Before every SUT has joined: the first that ended already.
  std::optional<std::string> early_end() {
    for (Sut& sut : suts_)
      if (sut.process->poll()) return describe_end(sut);
    return std::nullopt;
  }

  /// After a SUT was lost: how those that ended did so; empty: nothing is known.
  std::string post_mortem() {
    std::string text;
    for (Sut& sut : suts_)
      if (sut.process->wait(std::chrono::milliseconds(200))) text += "; " + describe_end(sut);
    return text;
  }

  void let_leave() {
    for (Sut& sut : suts_) sut.process->wait(kLeaveLimit);
  }

 private:
  static std::string describe_end(Sut& sut) {
    std::ifstream log(sut.log);
    std::string last;
    for (std::string line; std::getline(log, line);)
      if (!line.empty()) last = line;
    return fmt::format(
        "the SUT of UAV \"{}\" ({}) {}{}", sut.uav, sut.process->program(),
        sut.process->poll()->description,
        last.empty() ? "" : fmt::format("; its last words in {}: {}", sut.log.string(), last));
  }

  std::vector<Sut> suts_;
};

/// A folder that only this process writes results to while the object lives.
class FolderLock {
 public:
  explicit FolderLock(const std::filesystem::path& folder)
      : fd_(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    if (fd_ >= 0 && flock(fd_, LOCK_EX | LOCK_NB) == 0) return;
    const bool is_taken = fd_ >= 0 && errno == EWOULDBLOCK;
    const std::string why =
        is_taken ? "another run writes there; give this one a folder of its own with --out"
                 : std::strerror(errno);
    if (fd_ >= 0) close(fd_);
    throw Error(is_taken ? ErrorCode::kUsage : ErrorCode::kSetup, folder.string() + ": " + why);
  }
  ~FolderLock() { close(fd_); }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int fd_;
};

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    throw Error(ErrorCode::kSetup, fmt::format("{}: {}", folder.string(), error.message()));
}

/// Nothing of an earlier trial may be taken for this one's.
void clear_folder(const std::filesystem::path& folder) {
  for (const std::filesystem::path& file :
       {std::filesystem::path(experiment::kResultFile), std::filesystem::path(kRecordFile)}) {
    std::error_code error;
    std::filesystem::remove(folder / file, error);
    if (error)
      throw Error(ErrorCode::kSetup,
                  fmt::format("{}: {}", (folder / file).string(), error.message()));
  }
}

/// @throws Error(kBadFile) for a SUT that cannot be started.
void require_programs(const scenario::Scenario& scenario) {
  for (const scenario::UavSetup& uav : scenario.uavs) try {
      find_program(uav.sut.command.front());
    } catch (const Error& e) {
      throw Error(ErrorCode::kBadFile, {scenario.file.string()},
                  fmt::format("the SUT of UAV \"{}\": {}", uav.placement.name, e.what()));
    }
}

std::string instructions(const TrialSpec& spec, const std::string& address,
                         const std::string& token) {
  std::string text;
  for (const scenario::UavSetup& uav : spec.scenario.uavs)
    text += fmt::format("TETHER_ADDRESS={} TETHER_TOKEN={} TETHER_UAV={} TETHER_CLOCK='{}' {}\n",
                        address, token, uav.placement.name, clock_setting(spec.condition),
                        fmt::join(command_line(uav.sut), " "));
  return text;
}

/// A camera's first image costs the most by far (GL start-up, shaders); it is made while the SUTs'
/// processes start.
void warm_up_cameras(sim::Simulator& simulator) {
  sim::Snapshot snapshot;
  simulator.capture(snapshot);
  for (std::size_t u = 0; u < simulator.world().uavs.size(); ++u) {
    const auto& sensors = simulator.world().uavs[u].sensors;
    for (std::size_t s = 0; s < sensors.size(); ++s)
      if (sensors[s].kind() == uav::SensorKind::kCamera) simulator.measure(snapshot, u, s, 0);
  }
}

/// The coordinator's run with its SUTs, up to the closed record.
coordinator::RunReport conduct(const TrialSpec& spec, sim::Simulator& simulator,
                               const TrialObserver& observer) {
  const std::string token = token_of_run();
  const auto recorder = record::make_mcap_recorder(spec.folder / kRecordFile);
  coordinator::Coordinator coordinator(simulator, *recorder,
                                       run_options(spec, simulator.world(), token), host_now);
  const auto server = link::listen_tcp(spec.listen, kHelloTimeout, coordinator.events());
  const std::string address = link::to_string(server->address());

  Suts suts;
  if (!spec.external_sut) suts.start(spec, address, token);
  warm_up_cameras(simulator);
  if (spec.external_sut && observer.on_listening)
    observer.on_listening(instructions(spec, address, token));

  bool joined = false;
  coordinator::RunHooks hooks;
  hooks.should_stop = [&]() -> std::optional<std::pair<RunEnd, std::string>> {
    if (interrupted())
      return std::pair(RunEnd::kInterrupted, std::string("interrupted by the user"));
    if (!joined)
      if (const auto end = suts.early_end()) return std::pair(RunEnd::kSutLost, *end);
    return std::nullopt;
  };
  hooks.on_status = [&](const coordinator::RunStatus& status) {
    joined = status.joined == spec.scenario.uavs.size();
    if (observer.on_status) observer.on_status(status);
  };
  hooks.on_refused = observer.on_refused;
  auto report = coordinator.run(*server, hooks);
  if (report.end == RunEnd::kSutLost && joined) report.reason += suts.post_mortem();
  if (report.end == RunEnd::kFinished) suts.let_leave();
  return report;
}

std::vector<experiment::TaskEnd> task_ends(const coordinator::RunReport& report) {
  std::vector<experiment::TaskEnd> ends;
  for (const auto& sut : report.suts)
    if (sut.finish)
      ends.push_back({sut.uav, sut.finish->reached_goal, sut.finish->outcome, sut.finish->details});
  return ends;
}

/// A run that never began (no SUT joined) leaves no record worth reading.
experiment::TrialResult judge(const TrialSpec& spec, const coordinator::RunReport& report) {
  if (!report.began) {
    std::filesystem::remove(spec.folder / kRecordFile);
    auto result =
        experiment::make_setup_failure(spec.scenario, spec.condition, spec.seed, report.reason);
    if (report.end == RunEnd::kInterrupted) result.end = experiment::kEndInterrupted;
    return result;
  }
  const record::Record record = record::read_record(spec.folder / kRecordFile);
  auto result = experiment::make_result(spec.scenario, spec.condition, record, task_ends(report));
  const audit::Verdict verdict = audit::audit(record);
  const std::string text = audit::to_text(verdict, 0);
  result.audit = {verdict.passed(), text.substr(0, text.find('\n'))};
  if (result.outcome == experiment::Outcome::kFailed)
    result.reason = report.reason;
  else if (!verdict.passed())
    experiment::invalidate(result, "the record breaks the rules of time: " + result.audit->summary);
  return result;
}

std::string utc_now() {
  return fmt::format(
      "{:%Y-%m-%dT%H:%M:%SZ}",
      fmt::gmtime(std::chrono::system_clock::to_time_t(std::chrono::system_clock::now())));
}

}  // namespace

experiment::TrialResult run_trial(const TrialSpec& spec, const TrialObserver& observer) {
  // Whatever is wrong with the user's files shows before anything is written.
  sim::World world =
      sim::load_world(scenario::world_request(spec.scenario, spec.seed), observer.warn);
  scenario::resolve_timings(spec.scenario, world);
  world.step = spec.scenario.step;
  if (!spec.external_sut) require_programs(spec.scenario);
  make_folder(spec.folder);
  const FolderLock lock(spec.folder);
  clear_folder(spec.folder);

  const std::string started_at = utc_now();
  experiment::TrialResult result;
  try {
    const auto simulator = sim::make_mujoco_simulator(std::move(world), observer.warn);
    result = judge(spec, conduct(spec, *simulator, observer));
    result.versions["simulator"] = simulator->description();
  } catch (const Error& e) {
    result = experiment::make_setup_failure(spec.scenario, spec.condition, spec.seed, e.what());
  }
  result.versions["tether"] = version();
  result.this_run.started_at = started_at;
  result.this_run.machine = describe_machine();
  experiment::write_result(spec.folder, result);
  return result;
}

}  // namespace tether::app
