#include "physics_model.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <mujoco/mujoco.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <tether/autopilot/flight_controller.h>
#include <tether/client/simulated_vehicle.h>
#include <tether/coordinator/coordinator.h>
#include <tether/link/server.h>
#include <tether/os/machine.h>
#include <tether/record/writer.h>
#include <tether/sim_mujoco/mujoco_simulator.h>
#include <tether/sim_sdf/load_world.h>

// What a second of flight costs for each UAV with 1, 16, 64 and 256 UAVs: a whole coordinator with
// its record and the embedded simulator, over loopback to a process with one thread for each UAV.
// Each program reads every sample of the IMU, or every image, and commands a velocity; or reads an
// IMU of 200 Hz, alone or with GNSS (10 Hz), barometer and magnetometer (50 Hz); or is the
// companion of a built-in flight controller, and waits, or reads all that this sends. Clocks are
// scripted, so that the flights are the same in every run.
//   fleet_bench [SECONDS OF ST [1|16|64|256|camera|sensors|idle|active]]
// All figures are milliseconds for each UAV and second of ST. CPU time does not depend much on what
// else the machine does; wall time does. In real time are flights with UAVs × wall ≤ 1000. Each
// flight is flown twice: to read the CPU time of the parts takes time itself, so the wall time, the
// host's CPU time and the programs' are those of a flight in which the parts are not measured.
//   barrier  the coordinator and the link: all that is not in the other columns
//   physics  steps, and what lies within: rotors, controllers, contacts
//   sensors  states and samples; all that other threads draw
//   truth    the ground truth, for the record: poses, clearances, contacts
//   record   writing it
//   pilot    flight controllers: their steps
// The yardsticks, in the same program: the steps of the engine alone with the same world, and as
// many exchanges of 64 bytes each way, by one thread that polls, as there were interactions.
namespace tether {
namespace {

using namespace std::chrono_literals;

constexpr const char* kToken = "benchmark";
constexpr Duration kComputing = 1ms;

Duration cpu_of_thread() {
  return os::read_clock(CLOCK_THREAD_CPUTIME_ID);
}

/// CPU time by part, without what measuring it takes.
class Account {
 public:
  template <class F>
  auto measure(F&& f) {
    if (!is_open) return f();
    const Timed timed(*this);
    return f();
  }
  bool is_open = true;
  Duration sum() const { return sum_ - calls_ * overhead(); }
  static Duration overhead() {
    static const Duration overhead = [] {
      constexpr int kCalls = 100'000;
      Account empty;
      for (int i = 0; i < kCalls; ++i) empty.measure([] {});
      return empty.sum_ / kCalls;
    }();
    return overhead;
  }
  std::int64_t calls() const { return calls_; }

 private:
  struct Timed {
    explicit Timed(Account& of) : account(of), begin(cpu_of_thread()) {}
    ~Timed() {
      account.sum_ += cpu_of_thread() - begin;
      ++account.calls_;
    }
    Account& account;
    Duration begin;
  };
  Duration sum_{0};
  std::int64_t calls_ = 0;
};

struct Accounts {
  explicit Accounts(bool are_open) {
    for (Account* part : all()) part->is_open = are_open;
  }
  std::array<Account*, 5> all() { return {&physics, &sensors, &truth, &record, &pilot}; }
  Account physics, sensors, truth, record, pilot;
};

class TimedSimulator final : public sim::Simulator {
 public:
  TimedSimulator(std::unique_ptr<Simulator> inner, Accounts& accounts)
      : inner_(std::move(inner)), accounts_(accounts) {}

  const sim::World& world() const override { return inner_->world(); }
  StepGrid grid() const override { return inner_->grid(); }
  SimTime now() const override { return inner_->now(); }
  void reset(std::uint64_t seed) override { inner_->reset(seed); }
  void advance_to(SimTime t) override {
    accounts_.physics.measure([&] { inner_->advance_to(t); });
  }
  bool takes_setpoints() const override { return inner_->takes_setpoints(); }
  void apply(std::size_t uav, const uav::Setpoint& setpoint) override {
    inner_->apply(uav, setpoint);
  }
  void capture(sim::Snapshot& snapshot) const override {
    accounts_.sensors.measure([&] { inner_->capture(snapshot); });
  }
  uav::Sample measure(const sim::Snapshot& snapshot, std::size_t uav, std::size_t sensor,
                      std::uint64_t index) override {
    return accounts_.sensors.measure([&] { return inner_->measure(snapshot, uav, sensor, index); });
  }
  void expect(const sim::Snapshot& snapshot, std::size_t uav, std::size_t sensor,
              std::uint64_t index) override {
    inner_->expect(snapshot, uav, sensor, index);
  }
  std::optional<sim::SimulatorWork> work() const override { return inner_->work(); }
  sim::GroundTruth ground_truth(std::size_t uav) const override {
    return inner_->ground_truth(uav);
  }
  bool reports_contacts() const override { return inner_->reports_contacts(); }
  std::vector<sim::Contact> take_contacts() override { return inner_->take_contacts(); }
  std::optional<sim::Clearance> clearance(std::size_t uav) const override {
    return accounts_.truth.measure([&] { return inner_->clearance(uav); });
  }
  std::optional<energy::Status> battery(std::size_t uav) const override {
    return inner_->battery(uav);
  }
  void computing(std::size_t uav, double cores) override { inner_->computing(uav, cores); }
  std::string description() const override { return inner_->description(); }

 private:
  std::unique_ptr<Simulator> inner_;
  Accounts& accounts_;
};

class TimedRecorder final : public record::Recorder {
 public:
  TimedRecorder(const std::filesystem::path& file, Account& account)
      : inner_(record::make_mcap_recorder(file)), account_(account) {}
  void write(const record::Header& m) override { inner_->write(m); }
  void write(SimTime at, const record::Message& m) override {
    account_.measure([&] { inner_->write(at, m); });
  }
  void flush() override {
    account_.measure([&] { inner_->flush(); });
  }
  void write(const record::Footer& m) override {
    account_.measure([&] { inner_->write(m); });
  }

 private:
  std::unique_ptr<record::Recorder> inner_;
  Account& account_;
};

class TimedController final : public autopilot::FlightController {
 public:
  TimedController(std::unique_ptr<FlightController> inner, Account& account)
      : inner_(std::move(inner)), account_(account) {}
  autopilot::Actions step(const autopilot::Sensed& sensed,
                          const std::vector<autopilot::Bytes>& received) override {
    return account_.measure([&] { return inner_->step(sensed, received); });
  }

 private:
  std::unique_ptr<FlightController> inner_;
  Account& account_;
};

/// What the program of a UAV does; `kIdle` and `kActive` are companions of flight controllers.
enum class Program { kImu, kCamera, kFastImu, kSensors, kIdle, kActive };
constexpr std::string_view kPrograms[] = {"imu", "camera", "200 Hz", "sensors", "idle", "active"};
bool is_companion(Program program) {
  return program == Program::kIdle || program == Program::kActive;
}

/// In the air above the corridor, in a square.
sim::World make_world(std::size_t uavs, Program program) {
  const bool with_cameras = program == Program::kCamera;
  const std::filesystem::path root = TETHER_SOURCE_DIR;
  sim::WorldRequest request;
  request.world = root / "data/worlds/corridor.sdf";
  const auto side = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(uavs))));
  const double height_m = with_cameras ? 1.2 : 20.0;
  const double apart_m = with_cameras ? 0.8 : 4.0;
  for (std::size_t i = 0; i < uavs; ++i) {
    const double x_m = apart_m * static_cast<double>(i / side);
    const double y_m = apart_m * (static_cast<double>(i % side) - 0.5 * static_cast<double>(side));
    request.uavs.push_back({.name = fmt::format("uav{}", i + 1),
                            .model = root / "data/models/hummingbird/model.sdf",
                            .p_WB = {x_m, y_m, height_m},
                            .yaw_rad = 0.0});
  }
  sim::World world = sim::load_world(request, [](const Warning&) {});
  for (sim::Uav& uav : world.uavs) {
    if (program == Program::kSensors) {
      uav.sensors.push_back({"navsat", {}, 10.0, sim::NavSatModel{}});
      uav.sensors.push_back({"barometer", {}, 50.0, sim::BarometerModel{}});
      uav.sensors.push_back({"magnetometer", {}, 50.0, sim::MagnetometerModel{}});
    }
    for (sim::Sensor& sensor : uav.sensors) {
      const bool is_imu = std::holds_alternative<sim::ImuModel>(sensor.model);
      if (is_imu && (program == Program::kFastImu || program == Program::kSensors))
        sensor.update_rate_hz = 200.0;
      if (auto* camera = std::get_if<sim::CameraModel>(&sensor.model))
        camera->intrinsics = uav::CameraModel::from_horizontal_fov(
            640, 480, camera->intrinsics.horizontal_fov_rad());
    }
  }
  return world;
}

coordinator::RunOptions run_options(const sim::World& world, Program program, Duration seconds,
                                    Account& pilot) {
  coordinator::RunOptions options;
  options.token = kToken;
  options.time_limit = seconds + 10s;
  for (const sim::Uav& uav : world.uavs) {
    coordinator::UavOptions own;
    for (const sim::Sensor& sensor : uav.sensors)
      own.timings.emplace_back(uav::PeriodicTiming{
          .period = Duration(std::llround(1e9 / sensor.update_rate_hz)), .delay = {}});
    if (is_companion(program))
      own.controller = coordinator::ControllerOptions{
          .name = "built-in",
          .estimate = "truth",
          .make =
              [&pilot, airframe = uav.airframe, gravity_m_s2 = world.gravity_m_s2] {
                return std::make_unique<TimedController>(
                    autopilot::make_built_in({.limits = flight_limits(airframe),
                                              .hover_thrust_N = airframe.mass_kg * gravity_m_s2,
                                              .starts_in_air = true}),
                    pilot);
              },
          .period = autopilot::kBuiltInPeriod};
    options.uavs.push_back(own);
  }
  return options;
}

/// The program of one UAV.
void fly(const link::Address& address, const std::string& uav, Program program, Duration seconds) {
  client::ConnectOptions options;
  options.address = address;
  options.token = kToken;
  options.uav = uav;
  options.time = client::make_scripted_source(kComputing);
  const auto connected = client::connect(std::move(options));
  if (!connected) throw std::runtime_error(connected.failure().message);
  client::Vehicle& vehicle = **connected;
  while (program == Program::kIdle && vehicle.now() < ExecTime(seconds))
    if (!vehicle.sleep_for(100ms)) break;
  while (program == Program::kActive && vehicle.now() < ExecTime(seconds))
    if (const auto got = vehicle.receive_or_measure(10ms, {}, link::kMaxReceived);
        !got && got.failure().kind != Failure::Kind::kNothingYet)
      break;
  const bool is_fast = program == Program::kFastImu || program == Program::kSensors;
  for (int i = 0; is_fast && vehicle.now() < ExecTime(seconds); ++i) {
    if (!vehicle.read<uav::ImuSample>("imu")) break;
    if (program == Program::kFastImu) continue;
    if (i % 4 == 0)
      static_cast<void>(
          vehicle.read<uav::BarometerSample>("barometer", client::Read::kIfAvailable));
    if (i % 4 == 2)
      static_cast<void>(
          vehicle.read<uav::MagnetometerSample>("magnetometer", client::Read::kIfAvailable));
    if (i % 20 == 1)
      static_cast<void>(vehicle.read<uav::NavSatSample>("navsat", client::Read::kIfAvailable));
  }
  double speed_m_s = 0.2;
  while (!is_fast && !is_companion(program) && vehicle.now() < ExecTime(seconds)) {
    const bool is_read = program == Program::kCamera
                             ? static_cast<bool>(vehicle.read<uav::CameraSample>("camera"))
                             : static_cast<bool>(vehicle.read<uav::ImuSample>("imu"));
    if (!is_read || !vehicle.command_velocity({{speed_m_s, 0.0, 0.0}, 0.1})) break;
    speed_m_s = -speed_m_s;
  }
  static_cast<void>(vehicle.finish(true, "flown", "{}"));
}

/// A process with a thread for each of `count`.
template <class F>
pid_t start_threads(std::size_t count, F&& run) {
  std::fflush(nullptr);
  const pid_t process = ::fork();
  if (process != 0) return process;
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < count; ++i) threads.emplace_back([&run, i] { run(i); });
  for (std::thread& thread : threads) thread.join();
  ::_exit(0);
}

Duration wait_for(pid_t process) {
  rusage usage{};
  ::wait4(process, nullptr, 0, &usage);
  const auto of = [](const timeval& t) { return Duration(t.tv_sec * 1s + t.tv_usec * 1us); };
  return of(usage.ru_utime) + of(usage.ru_stime);
}

// --- the yardsticks -----------------------------------------------------------------------------

Duration engine_alone(const sim::World& world, Duration seconds) {
  const sim::ModelPtr model = sim::make_physics_model(world, [](const Warning&) {});
  const sim::DataPtr data = sim::make_data(*model);
  for (std::size_t i = 0; i < world.uavs.size(); ++i)
    data->xfrc_applied[6 * (i + 1) + 2] = world.uavs[i].airframe.mass_kg * world.gravity_m_s2;
  const Duration begin = cpu_of_thread();
  for (SimTime st{}; st < SimTime(seconds); st += world.step) mj_step(model.get(), data.get());
  return cpu_of_thread() - begin;
}

/// One socket for each of `peers`, all of which exchange `each` times at once.
Duration bare_exchanges(std::size_t peers, std::uint64_t each) {
  using Frame = std::array<char, 64>;
  std::vector<pollfd> watched(peers);
  std::vector<int> ends(peers);
  for (std::size_t i = 0; i < peers; ++i) {
    std::array<int, 2> pair{};
    if (::socketpair(AF_UNIX, SOCK_STREAM, 0, pair.data()) != 0)
      throw std::runtime_error("no socket");
    watched[i] = {pair[0], POLLIN, 0};
    ends[i] = pair[1];
  }
  const pid_t process = start_threads(peers, [&](std::size_t i) {
    Frame frame{};
    for (std::uint64_t k = 0; k < each; ++k)
      if (::send(ends[i], frame.data(), frame.size(), 0) < 0 ||
          ::recv(ends[i], frame.data(), frame.size(), MSG_WAITALL) <= 0)
        return;
  });
  const Duration begin = cpu_of_thread();
  for (std::uint64_t left = peers * each; left > 0;) {
    ::poll(watched.data(), watched.size(), -1);
    for (pollfd& peer : watched) {
      if (peer.revents == 0) continue;
      Frame frame{};
      if (::recv(peer.fd, frame.data(), frame.size(), MSG_WAITALL) <= 0 ||
          ::send(peer.fd, frame.data(), frame.size(), 0) < 0)
        throw std::runtime_error("bare exchange failed");
      --left;
    }
  }
  const Duration taken = cpu_of_thread() - begin;
  wait_for(process);
  for (std::size_t i = 0; i < peers; ++i) ::close(watched[i].fd), ::close(ends[i]);
  return taken;
}

// --- the flights --------------------------------------------------------------------------------

struct Flight {
  Duration wall{0};
  Duration coordinator{0};  ///< CPU time of the host's thread
  Duration ahead{0};        ///< and of those that draw ahead
  Duration programs{0};
  double seconds = 0.0;  ///< ST
  std::uint64_t interactions = 0;
  std::uintmax_t bytes = 0;
  sim::SimulatorWork work;
};

Flight fly_fleet(const sim::World& world, Program program, Duration seconds, Accounts& accounts) {
  const int threads_ahead =
      program == Program::kCamera
          ? static_cast<int>(std::max(1U, std::thread::hardware_concurrency())) - 1
          : 0;
  TimedSimulator simulator(sim::make_mujoco_simulator(
                               world, [](const Warning&) {}, threads_ahead),
                           accounts);
  const std::filesystem::path file = std::filesystem::temp_directory_path() /
                                     ("tether_fleet_bench." + std::to_string(::getpid()) + ".mcap");
  TimedRecorder recorder(file, accounts.record);
  coordinator::Coordinator coordinator(
      simulator, recorder, run_options(world, program, seconds, accounts.pilot),
      [] { return WallTime(std::chrono::steady_clock::now().time_since_epoch()); });
  const auto server = link::listen_tcp({"127.0.0.1", 0}, 60s);
  const pid_t programs = start_threads(world.uavs.size(), [&](std::size_t i) {
    fly(server->address(), world.uavs[i].name, program, seconds);
  });
  const Duration begin = cpu_of_thread();
  const Duration begin_of_all = os::read_clock(CLOCK_PROCESS_CPUTIME_ID);
  const coordinator::RunReport report = coordinator.run(*server);
  const Duration own = cpu_of_thread() - begin;
  const Duration all = os::read_clock(CLOCK_PROCESS_CPUTIME_ID) - begin_of_all;
  const Flight flight{.wall = report.wall,
                      .coordinator = own,
                      .ahead = all - own,
                      .programs = wait_for(programs),
                      .seconds = to_seconds(report.st),
                      .interactions = report.interactions,
                      .bytes = std::filesystem::file_size(file),
                      .work = *simulator.work()};
  std::filesystem::remove(file);
  if (report.end != coordinator::RunEnd::kFinished) throw std::runtime_error(report.reason);
  return flight;
}

void print_row(std::size_t uavs, Program program, Duration seconds) {
  const sim::World world = make_world(uavs, program);
  Accounts closed(false);
  const Flight whole = fly_fleet(world, program, seconds, closed);
  Accounts parts(true);
  const Flight measured = fly_fleet(world, program, seconds, parts);
  Duration barrier = measured.coordinator;
  for (const Account* part : parts.all())
    barrier -= part->sum() + 2 * part->calls() * Account::overhead();

  const double uav_seconds = static_cast<double>(uavs) * whole.seconds;
  const auto each_ms = [&](Duration d) { return 1e3 * to_seconds(d) / uav_seconds; };
  fmt::print(
      "{:5} {:>7} | {:6.2f} {:8.2f} | {:7.2f} {:7.2f} {:7.2f} {:7.2f} {:7.2f} {:7.2f} | {:7.2f} |"
      " {:6.2f} {:6.2f} | {:6.1f} {:6.1f}\n",
      uavs, kPrograms[static_cast<std::size_t>(program)], each_ms(whole.wall),
      each_ms(whole.coordinator + whole.ahead), each_ms(barrier), each_ms(parts.physics.sum()),
      each_ms(parts.sensors.sum() + measured.ahead), each_ms(parts.truth.sum()),
      each_ms(parts.record.sum()), each_ms(parts.pilot.sum()), each_ms(whole.programs),
      each_ms(engine_alone(world, seconds)),
      each_ms(bare_exchanges(uavs, whole.interactions / uavs)),
      static_cast<double>(whole.interactions) / uav_seconds,
      static_cast<double>(whole.bytes) * 1e-3 / uav_seconds);
  if (program == Program::kCamera)
    fmt::print("{} pictures, {} of them drawn ahead, {} in vain\n", whole.work.pictures,
               whole.work.drawn_ahead, whole.work.drawn_in_vain);
  std::fflush(stdout);
}

}  // namespace
}  // namespace tether

int main(int argc, char** argv) {
  using namespace tether;
  const auto seconds = std::chrono::seconds(argc > 1 ? std::atoi(argv[1]) : 10);
  fmt::print(
      "ms for each UAV and second of ST   | CPU time of the host, by part                   |"
      " CPU of  |  yardsticks   | each second\n"
      " UAVs program |   wall      CPU | barrier physics sensors   truth  record   pilot |"
      " programs| engine   wire |  calls  kB\n");
  try {
    const std::string_view only = argc > 2 ? argv[2] : "";
    for (const std::size_t uavs : {1U, 16U, 64U, 256U})
      if (only.empty() || only == std::to_string(uavs)) print_row(uavs, Program::kImu, seconds);
    if (only.empty() || only == "camera") print_row(16, Program::kCamera, seconds);
    for (const Program program : {Program::kFastImu, Program::kSensors})
      if (only.empty() || only == "sensors") print_row(1, program, seconds);
    for (const Program program : {Program::kIdle, Program::kActive})
      if (only.empty() || only == kPrograms[static_cast<std::size_t>(program)])
        for (const std::size_t uavs : {1U, 64U}) print_row(uavs, program, seconds);
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 3;
  }
  return 0;
}
