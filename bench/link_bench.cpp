// What the link costs above the bare wire. Each benchmark takes turns, a few exchanges long,
// between a raw TCP ping-pong and a call of a vehicle that moves as many bytes, both over loopback
// to a thread of this program: a whole coordinator, with its record, over a world that is always
// there already; so whatever disturbs the machine disturbs both. Counters: the
// medians [us] and their ratio.

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <arpa/inet.h>
#include <benchmark/benchmark.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <tether/client/simulated_vehicle.h>
#include <tether/coordinator/coordinator.h>
#include <tether/link/server.h>
#include <tether/record/writer.h>
#include <tether/sim/simulator.h>

namespace {

using namespace tether;
using std::chrono::steady_clock;

constexpr int kWidthPx = 640;
constexpr int kHeightPx = 480;
constexpr std::size_t kImageBytes = std::size_t{kWidthPx} * kHeightPx * 3;
constexpr std::size_t kPingBytes = 64;

// --- the raw exchange ---------------------------------------------------------------------------

int require(int result) {
  if (result < 0) throw std::runtime_error("raw socket call failed");
  return result;
}

void no_delay(int descriptor) {
  const int on = 1;
  ::setsockopt(descriptor, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
}

bool receive_all(int descriptor, std::span<std::uint8_t> bytes) {
  return ::recv(descriptor, bytes.data(), bytes.size(), MSG_WAITALL) ==
         static_cast<ssize_t>(bytes.size());
}

bool send_all(int descriptor, std::span<const std::uint8_t> bytes) {
  return ::send(descriptor, bytes.data(), bytes.size(), MSG_NOSIGNAL) ==
         static_cast<ssize_t>(bytes.size());
}

/// Blocking sockets, one thread at each end, nothing but the bytes.
class RawExchange {
 public:
  explicit RawExchange(std::size_t answer_bytes) : answer_(answer_bytes) {
    const int listener = require(::socket(AF_INET, SOCK_STREAM, 0));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    auto* const generic = reinterpret_cast<sockaddr*>(&address);
    require(::bind(listener, generic, size));
    require(::listen(listener, 1));
    require(::getsockname(listener, generic, &size));
    client_ = require(::socket(AF_INET, SOCK_STREAM, 0));
    require(::connect(client_, generic, size));
    server_ = require(::accept(listener, nullptr, nullptr));
    ::close(listener);
    no_delay(client_);
    no_delay(server_);
    thread_ = std::thread([this, answer_bytes] { serve(answer_bytes); });
  }
  ~RawExchange() {
    ::shutdown(client_, SHUT_RDWR);
    thread_.join();
    ::close(client_);
    ::close(server_);
  }
  RawExchange(const RawExchange&) = delete;
  RawExchange& operator=(const RawExchange&) = delete;

  void exchange() {
    if (!send_all(client_, ping_) || !receive_all(client_, answer_)) require(-1);
  }

 private:
  void serve(std::size_t answer_bytes) {
    std::vector<std::uint8_t> ping(kPingBytes);
    const std::vector<std::uint8_t> answer(answer_bytes, 42);
    while (receive_all(server_, ping) && send_all(server_, answer)) {
    }
  }

  std::vector<std::uint8_t> ping_ = std::vector<std::uint8_t>(kPingBytes);
  std::vector<std::uint8_t> answer_;
  int client_ = -1;
  int server_ = -1;
  std::thread thread_;
};

// --- the other side of the vehicle --------------------------------------------------------------

/// A world that is always there already: steps cost nothing, and images lie ready.
class StillSimulator final : public sim::Simulator {
 public:
  StillSimulator() {
    sim::Uav uav;
    uav.name = "uav1";
    uav.sensors.push_back({.name = "camera", .X_BS = {}, .update_rate_hz = 0.0, .model = {}});
    std::get<sim::CameraModel>(uav.sensors[0].model).intrinsics =
        uav::CameraModel::from_horizontal_fov(kWidthPx, kHeightPx, 1.0);
    world_.uavs.push_back(uav);
    make_image_ready();
  }

  void make_image_ready() { image_.rgb.assign(kImageBytes, 42); }

  const sim::World& world() const override { return world_; }
  StepGrid grid() const override { return StepGrid(world_.step); }
  SimTime now() const override { return now_; }
  void reset(std::uint64_t) override { now_ = {}; }
  void advance_to(SimTime t) override { now_ = t; }
  void apply(std::size_t, const uav::Setpoint&) override {}
  void capture(sim::Snapshot& snapshot) const override { snapshot.at = now_; }
  uav::Sample measure(const sim::Snapshot& snapshot, std::size_t, std::size_t,
                      std::uint64_t index) override {
    return uav::CameraSample{snapshot.at, index, kWidthPx, kHeightPx, std::move(image_.rgb)};
  }
  sim::GroundTruth ground_truth(std::size_t) const override { return {now_, {}}; }
  bool reports_contacts() const override { return false; }
  std::vector<sim::Contact> take_contacts() override { return {}; }
  std::optional<sim::Clearance> clearance(std::size_t) const override { return std::nullopt; }
  std::string description() const override { return "still"; }

 private:
  sim::World world_;
  SimTime now_{};
  uav::CameraSample image_;
};

/// A whole coordinator with its record, in a thread of its own.
class CoordinatorHost {
 public:
  CoordinatorHost()
      : folder_(std::filesystem::temp_directory_path() /
                ("tether_link_bench." + std::to_string(::getpid()))),
        recorder_(folder_, simulator_),
        coordinator_(simulator_, recorder_, run_options(), wall_now),
        server_(link::listen_tcp({"127.0.0.1", 0}, std::chrono::seconds(10))),
        thread_([this] { coordinator_.run(*server_); }) {}
  ~CoordinatorHost() { thread_.join(); }

  client::ConnectOptions options() const {
    client::ConnectOptions options;
    options.address = server_->address();
    options.token = kToken;
    return options;
  }

 private:
  static constexpr const char* kToken = "benchmark";

  /// Records as always; and once the reply to a read has gone out, has the next image lie ready in
  /// memory, as a renderer would.
  class Recorder final : public record::Recorder {
   public:
    Recorder(const std::filesystem::path& folder, StillSimulator& simulator)
        : folder_(folder), simulator_(&simulator) {
      std::filesystem::create_directories(folder_);
      file_ = record::make_mcap_recorder(folder_ / "record.mcap");
    }
    ~Recorder() override {
      file_.reset();
      std::filesystem::remove_all(folder_);
    }
    void write(const record::Header& m) override { file_->write(m); }
    void write(SimTime at, const record::Message& m) override {
      const auto* interaction = std::get_if<record::Interaction>(&m);
      if (interaction && interaction->kind == record::kSensor) simulator_->make_image_ready();
      file_->write(at, m);
    }
    void flush() override { file_->flush(); }
    void write(const record::Footer& m) override { file_->write(m); }

   private:
    std::filesystem::path folder_;
    StillSimulator* simulator_;
    std::unique_ptr<record::Recorder> file_;
  };

  static WallTime wall_now() { return WallTime(steady_clock::now().time_since_epoch()); }

  static coordinator::RunOptions run_options() {
    coordinator::RunOptions options;
    options.token = kToken;
    options.uavs = {{.timings = {uav::OnDemandTiming{uav::ConstantDelay{}}}}};
    return options;
  }

  std::filesystem::path folder_;
  StillSimulator simulator_;
  Recorder recorder_;
  coordinator::Coordinator coordinator_;
  std::unique_ptr<link::Server> server_;
  std::thread thread_;
};

// --- comparing ----------------------------------------------------------------------------------

double time_us(const std::function<void()>& exchange) {
  const auto begin = steady_clock::now();
  exchange();
  return std::chrono::duration<double, std::micro>(steady_clock::now() - begin).count();
}

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

using Call = std::function<Status(client::Vehicle&)>;

/// Exchanges of one sort before it is the other's turn.
constexpr int kTurn = 20;

/// Takes turns of raw exchanges that are answered with `answer_bytes` and of calls of a vehicle on
/// `host`.
void compare(benchmark::State& state, std::size_t answer_bytes, const CoordinatorHost& host,
             const Call& call) {
  RawExchange raw(answer_bytes);
  auto vehicle = client::connect(host.options());
  if (!vehicle) return state.SkipWithError(vehicle.failure().message.c_str());

  const auto call_vehicle = [&] {
    if (const Status done = call(**vehicle); !done) {
      state.SkipWithError(done.failure().message.c_str());
    }
  };
  constexpr int kWarmUp = 50;
  for (int i = 0; i < kWarmUp; ++i) {
    raw.exchange();
    call_vehicle();
  }
  std::vector<double> raw_us;
  std::vector<double> tether_us;
  for ([[maybe_unused]] auto _ : state) {
    for (int i = 0; i < kTurn; ++i) raw_us.push_back(time_us([&] { raw.exchange(); }));
    for (int i = 0; i < kTurn; ++i) tether_us.push_back(time_us(call_vehicle));
    state.SetIterationTime(tether_us.back() * 1e-6);
  }
  if (!(*vehicle)->finish(true, "measured", "{}")) state.SkipWithError("the run did not end well");
  state.counters["raw_us"] = median(raw_us);
  state.counters["tether_us"] = median(tether_us);
  state.counters["ratio"] = median(tether_us) / median(raw_us);
}

/// Against 64 bytes each way. Required: at most 1.25 times the raw exchange.
void command(benchmark::State& state) {
  const CoordinatorHost host;
  compare(state, kPingBytes, host, [](client::Vehicle& vehicle) {
    return vehicle.command_velocity({{1.0, 0.0, 0.0}, 0.1});
  });
}

/// Against as many bytes as the image has. Required: at most 1.5 times the raw exchange.
void image(benchmark::State& state) {
  const CoordinatorHost host;
  compare(state, kImageBytes, host, [](client::Vehicle& vehicle) -> Status {
    const auto sample = vehicle.read<uav::CameraSample>("camera");
    if (!sample) return sample.failure();
    return ok_status();
  });
}

BENCHMARK(command)->UseManualTime()->Iterations(1'000);
BENCHMARK(image)->UseManualTime()->Iterations(50);

}  // namespace
