// What the link costs above the bare wire. Each benchmark takes turns, a few exchanges long,
// between a raw TCP ping-pong and a call of a vehicle that moves as many bytes, both over loopback
// to a thread of this program; so whatever disturbs the machine disturbs both. Counters: the
// medians [us] and their ratio.

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
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
#include <tether/link/server.h>

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

/// Where a vehicle connects: something that answers in a thread of its own until destroyed.
class Host {
 public:
  virtual ~Host() = default;
  virtual client::ConnectOptions options() const = 0;
};

/// A server that answers at once, with the world always there already: the link alone.
class BareHost final : public Host, private link::ServerEvents {
 public:
  BareHost() : server_(link::listen_tcp({"127.0.0.1", 0}, std::chrono::seconds(10), *this)) {
    image_ = next_image();
    thread_ = std::thread([this] {
      while (!stopping_) server_->poll(std::chrono::milliseconds(50));
    });
  }
  ~BareHost() override {
    stopping_ = true;
    thread_.join();
  }

  client::ConnectOptions options() const override {
    client::ConnectOptions options;
    options.address = server_->address();
    return options;
  }

 private:
  static uav::CameraSample next_image() {
    return {SimTime{}, 0, kWidthPx, kHeightPx, std::vector<std::uint8_t>(kImageBytes, 42)};
  }

  void on_connected(link::PeerId, const std::string&) override {}
  void on_closed(link::PeerId, const Failure&) override {}
  void on_message(link::PeerId peer, link::Message message) override {
    if (std::holds_alternative<link::Hello>(message)) return server_->send(peer, welcome());
    if (const auto* request = std::get_if<link::Request>(&message)) answer(peer, *request);
  }

  void answer(link::PeerId peer, const link::Request& request) {
    link::Reply reply{request.sequence, request.issued_at, std::nullopt};
    const bool wants_image = std::holds_alternative<link::ReadSensor>(request.body);
    if (wants_image) reply.sample = std::move(image_);
    server_->send(peer, std::move(reply));
    // A renderer would have the next one ready in memory just so.
    if (wants_image) image_ = next_image();
  }

  static link::Welcome welcome() {
    link::Welcome welcome;
    welcome.catalogue.sensors = {
        {"camera",
         {},
         30.0,
         uav::CameraProperties{uav::CameraModel::from_horizontal_fov(kWidthPx, kHeightPx, 1.0)}}};
    return welcome;
  }

  uav::CameraSample image_;
  std::unique_ptr<link::Server> server_;
  std::atomic<bool> stopping_ = false;
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
void compare(benchmark::State& state, std::size_t answer_bytes, const Host& host,
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
  state.counters["raw_us"] = median(raw_us);
  state.counters["tether_us"] = median(tether_us);
  state.counters["ratio"] = median(tether_us) / median(raw_us);
}

/// Against 64 bytes each way. Required: at most 1.25 times the raw exchange.
void command(benchmark::State& state) {
  const BareHost host;
  compare(state, kPingBytes, host, [](client::Vehicle& vehicle) {
    return vehicle.command_velocity({{1.0, 0.0, 0.0}, 0.1});
  });
}

/// Against as many bytes as the image has. Required: at most 1.5 times the raw exchange.
void image(benchmark::State& state) {
  const BareHost host;
  compare(state, kImageBytes, host, [](client::Vehicle& vehicle) -> Status {
    const auto sample = vehicle.read_camera("camera");
    if (!sample) return sample.failure();
    return ok_status();
  });
}

BENCHMARK(command)->UseManualTime()->Iterations(1'000);
BENCHMARK(image)->UseManualTime()->Iterations(50);

}  // namespace
