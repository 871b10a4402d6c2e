#include "cancellation.h"

#include <atomic>
#include <condition_variable>
#include <cstdlib>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <tether/client/exec/clock_page.h>
#include <tether/client/exec/local_socket.h>
#include <tether/client/simulated_vehicle.h>
#include <tether/client/subscription.h>

namespace tether::client {
namespace {

using namespace std::chrono_literals;

/// tether-exec as far as a vehicle sees it: a socket, a clock, and answers as the test says (none:
/// the call stays open).
class FakeExec {
 public:
  using Answer = std::function<std::optional<link::Message>(const link::Request&)>;

  explicit FakeExec(Answer answer, bool free_running = false) : answer_(std::move(answer)) {
    welcome_.free_running = free_running;
    welcome_.catalogue.sensors = {{"imu", {}, 100.0, uav::ImuProperties{}},
                                  {"down", {}, 10.0, uav::RangeProperties{}}};
    clock_ = make_clock_page().value();
    clock_.page->publish({ExecTime(1s), read_monotonic(), 1.0, true});
    listener_ = listen_local(path()).value();
    thread_ = std::thread([this] { run(); });
  }
  ~FakeExec() {
    stopping_ = true;
    thread_.join();
    ::unlink(path().c_str());
    ::rmdir(folder_.c_str());
  }

  std::string path() const { return folder_ + "/socket"; }
  std::unique_ptr<Vehicle> connect() const {
    ConnectOptions options;
    options.exec_socket = path();
    auto vehicle = client::connect(std::move(options));
    EXPECT_TRUE(vehicle.ok()) << vehicle.failure().message;
    return std::move(*vehicle);
  }
  std::size_t connections() const { return connections_; }
  std::size_t requests() const { return requests_; }
  /// Refuses or drops all callers.
  void end(std::optional<link::Refusal> why) {
    const std::lock_guard lock(mutex_);
    end_ = true;
    why_ = std::move(why);
  }

 private:
  void run() {
    while (!stopping_) {
      pollfd nothing{-1, 0, 0};
      ::poll(&nothing, 1, 1);
      while (os::FileDescriptor accepted = accept_local(listener_)) {
        sockets_.emplace_back(std::move(accepted));
        ++connections_;
        EXPECT_TRUE(sockets_.back().send_clock(clock_.descriptor).ok());
      }
      for (auto& socket : sockets_) serve(socket);
      const std::lock_guard lock(mutex_);
      if (!end_) continue;
      for (auto& socket : sockets_) {
        if (why_) static_cast<void>(socket.send(*why_));
      }
      sockets_.clear();
    }
  }
  void serve(LocalSocket& socket) {
    auto packet = socket.receive();
    if (!packet || !packet->message) return;
    if (std::holds_alternative<link::Hello>(*packet->message)) {
      static_cast<void>(socket.send(welcome_));
    }
    const auto* request = std::get_if<link::Request>(&*packet->message);
    if (request == nullptr) return;
    ++requests_;
    if (const auto answer = answer_(*request)) static_cast<void>(socket.send(*answer));
  }
  static std::string make_folder() {
    std::string path = "/tmp/tether-fake-exec-XXXXXX";
    return ::mkdtemp(path.data());
  }

  std::string folder_ = make_folder();
  Answer answer_;
  link::Welcome welcome_;
  SharedClockPage clock_;
  os::FileDescriptor listener_;
  std::vector<LocalSocket> sockets_;
  std::atomic<std::size_t> connections_ = 0;
  std::atomic<std::size_t> requests_ = 0;
  std::atomic<bool> stopping_ = false;
  std::mutex mutex_;
  bool end_ = false;                  // guarded by mutex_
  std::optional<link::Refusal> why_;  // guarded by mutex_
  std::thread thread_;
};

std::optional<link::Message> grant(const link::Request& request) {
  link::Reply reply{request.sequence, request.issued_at, std::nullopt};
  const auto* read = std::get_if<link::ReadSensor>(&request.body);
  if (read != nullptr && read->sensor == 0) {
    reply.sample = uav::ImuSample{same_instant(request.issued_at), request.sequence, {}, {}, {}};
  }
  if (read != nullptr && read->sensor == 1) {
    reply.sample = uav::RangeSample{same_instant(request.issued_at), request.sequence, 1.0};
  }
  return reply;
}

std::optional<link::Message> all_but_the_rangefinder(const link::Request& request) {
  const auto* read = std::get_if<link::ReadSensor>(&request.body);
  if (read != nullptr && read->sensor == 1) return std::nullopt;
  return grant(request);
}

void wait_for(const std::function<bool()>& condition) {
  while (!condition()) std::this_thread::yield();
}

TEST(ConcurrentVehicle, ThreadsCallEachOnAConnectionOfItsOwn) {
  FakeExec exec(grant);
  const auto vehicle = exec.connect();
  EXPECT_TRUE(vehicle->is_concurrent());
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([&] {
      for (int k = 0; k < 50; ++k) {
        const ExecTime before = vehicle->now();
        ASSERT_GE(before, ExecTime(1s));
        const auto reading = vehicle->read_imu("imu");
        ASSERT_TRUE(reading.ok()) << reading.failure().message;
        ASSERT_GE(reading->sampled_at, same_instant(before));
        ASSERT_TRUE(vehicle->command_velocity({}).ok());
        ASSERT_TRUE(vehicle->annotate("topic", "{}").ok());
        ASSERT_TRUE(vehicle->sleep_for(1ms).ok());
      }
    });
  }
  for (auto& thread : threads) thread.join();
  EXPECT_LE(exec.connections(), 4u);
  EXPECT_EQ(exec.requests(), 4u * 50 * 3);
}

TEST(ConcurrentVehicle, ACallThatWaitsHoldsNoOther) {
  FakeExec exec(all_but_the_rangefinder);
  const auto vehicle = exec.connect();
  std::thread waiting(
      [&] { EXPECT_EQ(vehicle->read_range("down").failure().kind, Failure::Kind::kRunEnded); });
  wait_for([&] { return exec.requests() == 1; });
  EXPECT_TRUE(vehicle->read_imu("imu").ok());
  exec.end(link::Refusal{link::Refusal::Reason::kRunEnded, "the time is up"});
  waiting.join();
  const auto later = vehicle->read_imu("imu");
  EXPECT_EQ(later.failure().message, "the time is up");
}

TEST(ConcurrentVehicle, ALostConnectionEndsEveryCall) {
  FakeExec exec(all_but_the_rangefinder);
  const auto vehicle = exec.connect();
  std::thread waiting(
      [&] { EXPECT_EQ(vehicle->read_range("down").failure().kind, Failure::Kind::kDisconnected); });
  wait_for([&] { return exec.requests() == 1; });
  exec.end(std::nullopt);
  waiting.join();
  EXPECT_EQ(vehicle->command_velocity({}).failure().kind, Failure::Kind::kDisconnected);
}

TEST(ConcurrentVehicle, ASubscriptionEndsWithItsOpenRead) {
  FakeExec exec(all_but_the_rangefinder);
  const auto vehicle = exec.connect();
  auto subscription = subscribe_range(*vehicle, "down", [](const uav::RangeSample&) {});
  ASSERT_TRUE(subscription.ok());
  wait_for([&] { return exec.requests() == 1; });
  subscription->reset();
  EXPECT_TRUE(vehicle->read_imu("imu").ok());
}

// The end may come together with a reply: the call has succeeded then, on a connection that has
// just been shut down.
TEST(ConcurrentVehicle, ASubscriptionThatEndsSpoilsNoOtherCall) {
  FakeExec exec(grant);
  const auto vehicle = exec.connect();
  for (int i = 0; i < 100; ++i) {
    std::atomic<int> count = 0;
    auto subscription = subscribe_imu(*vehicle, "imu", [&](const uav::ImuSample&) { ++count; });
    ASSERT_TRUE(subscription.ok());
    wait_for([&] { return count > 0; });
    subscription->reset();
    ASSERT_TRUE(vehicle->command_velocity({}).ok()) << i;
  }
}

TEST(ConcurrentVehicle, AForkedChildConnectsByItself) {
  FakeExec exec(grant);
  const auto vehicle = exec.connect();
  const pid_t child = ::fork();
  if (child == 0) {
    const bool refused = vehicle->command_velocity({}).failure().kind == Failure::Kind::kInvalid;
    ConnectOptions options;
    options.exec_socket = exec.path();
    auto own = connect(std::move(options));
    ::_exit(refused && own.ok() && (*own)->command_velocity({}).ok() ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
  EXPECT_TRUE(vehicle->command_velocity({}).ok());
}

TEST(ConcurrentVehicle, FinishEndsItInGoodOrder) {
  FakeExec exec(grant);
  const auto vehicle = exec.connect();
  EXPECT_TRUE(vehicle->finish(true, "done", "").ok());
  EXPECT_EQ(vehicle->read_imu("imu").failure().message,
            "the mission is finished; no call is possible");
}

TEST(ConcurrentVehicle, SleepsByItselfInFreeRunning) {
  FakeExec exec(grant, true);
  const auto vehicle = exec.connect();
  const ExecTime before = vehicle->now();
  EXPECT_TRUE(vehicle->sleep_for(2ms).ok());
  EXPECT_GE(vehicle->now(), before + 2ms);
  EXPECT_EQ(exec.requests(), 0u);
}

TEST(ConcurrentVehicle, SaysWhyItCannotConnect) {
  ConnectOptions options;
  options.exec_socket = "/nowhere/socket";
  EXPECT_EQ(connect(std::move(options)).failure().kind, Failure::Kind::kDisconnected);
  ConnectOptions clocked;
  clocked.exec_socket = "/nowhere/socket";
  clocked.time = make_cpu_source(2.0);
  const auto failure = connect(std::move(clocked)).failure();
  EXPECT_EQ(failure.kind, Failure::Kind::kInvalid);
  EXPECT_NE(failure.message.find("TETHER_CLOCK"), std::string::npos);
}

}  // namespace
}  // namespace tether::client
