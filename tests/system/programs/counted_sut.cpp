// A SUT whose work is counted: counted_sut MODE
//
//   good       flies in small steps, and computes in between, under the stage "work"
//   slower     the same, with a fifth more of this work
//   waiter     the same, with a thread that only waits
//   at_once    a thread computes at the same time
//   meanwhile  a thread computes while the program waits for a reply
//   from_start a thread has computed since before it joined
//   process    starts a process
//   hands_over computes on a thread and waits for it: by a condition variable, pipes and futures
//   daemon     leaves a process behind before it joins, which computes when the program asks it
//   endless    computes for ever after its flight
//   native     runs itself again, without the emulator
#include <condition_variable>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <future>
#include <mutex>
#include <string>
#include <thread>

#include <sys/wait.h>
#include <unistd.h>

#include <tether/client/simulated_vehicle.h>

namespace {

using namespace std::chrono_literals;
using tether::client::Vehicle;

template <class T>
T require(tether::Result<T> result) {
  if (result) return std::move(result).value();
  std::fprintf(stderr, "counted_sut: %s\n", result.failure().message.c_str());
  std::_Exit(3);
}

void require(const tether::Status& status) {
  if (status) return;
  std::fprintf(stderr, "counted_sut: %s\n", status.failure().message.c_str());
  std::_Exit(3);
}

std::unique_ptr<Vehicle> join() {
  auto options = require(tether::client::options_from_environment());
  options.sut_name = "counted_sut";
  return require(tether::client::connect(std::move(options)));
}

/// Functions whose work depends on where on the stack their operands are.
std::size_t work_on_stack() {
  char buffer[3000];
  volatile char filling = 'x';
  std::memset(buffer, filling, sizeof buffer - 1);
  buffer[sizeof buffer - 1] = 0;
  return std::strlen(buffer) + (std::memchr(buffer + 1, 0, sizeof buffer - 1) != nullptr ? 1 : 0);
}

/// Arithmetic that no compiler can leave out, and memory of changing sizes.
void work(std::uint64_t steps) {
  volatile std::uint64_t state = steps;
  for (std::uint64_t i = 0; i < steps; ++i) state = state * 6364136223846793005u + i;
  const std::string text(static_cast<std::size_t>(state % 5000), 'x');
  if (text == "y") std::puts(text.c_str());
}

/// A thread that waits until it is woken, and then computes.
class Worker {
 public:
  explicit Worker(std::uint64_t steps) {
    std::thread([this, steps] {
      std::unique_lock lock(mutex_);
      is_awake_.wait(lock, [this] { return woken_; });
      while (true) {
        work(steps);
        if (pause_ > 0ms) std::this_thread::sleep_for(pause_);
      }
    }).detach();
  }
  void wake(std::chrono::milliseconds pause) {
    const std::lock_guard lock(mutex_);
    woken_ = true;
    pause_ = pause;
    is_awake_.notify_one();
  }

 private:
  std::mutex mutex_;
  std::condition_variable is_awake_;
  bool woken_ = false;
  std::chrono::milliseconds pause_{0};
};

/// Computes when it is asked, and answers.
void serve(int requests, int answers) {
  for (char byte = 0; read(requests, &byte, 1) == 1;) {
    work(200'000);
    if (write(answers, &byte, 1) != 1) return;
  }
}

/// A thread or a process, by two pipes.
class Server {
 public:
  Server() {
    if (pipe(requests_) != 0 || pipe(answers_) != 0) std::_Exit(3);
  }
  void serve_here() { serve(requests_[0], answers_[1]); }
  void ask() {
    char byte = 1;
    if (write(requests_[1], &byte, 1) != 1 || read(answers_[0], &byte, 1) != 1) std::_Exit(3);
  }

 private:
  int requests_[2] = {}, answers_[2] = {};
};

/// Work that several threads do, never two at a time.
class HandOver {
 public:
  HandOver() {
    std::thread([this] { server_.serve_here(); }).detach();
    std::thread([this] {
      for (std::unique_lock lock(mutex_);;) {
        changed_.wait(lock, [this] { return is_turn_of_worker_; });
        work(20'000);
        is_turn_of_worker_ = false;
        changed_.notify_all();
      }
    }).detach();
  }
  void work_once() {
    server_.ask();
    std::async(std::launch::async, [] { work(20'000); }).get();
    std::unique_lock lock(mutex_);
    is_turn_of_worker_ = true;
    changed_.notify_all();
    changed_.wait(lock, [this] { return !is_turn_of_worker_; });
  }

 private:
  Server server_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool is_turn_of_worker_ = false;
};

/// Forks twice, so that the process is no child of this one.
Server& leave_daemon() {
  static Server server;
  if (const pid_t child = fork(); child > 0) {
    waitpid(child, nullptr, 0);
    return server;
  }
  if (fork() > 0) std::_Exit(0);
  setsid();
  server.serve_here();
  std::_Exit(0);
}

void fly(Vehicle& vehicle, std::uint64_t tenths) {
  for (std::uint64_t i = 0; i < 100; ++i) {
    {
      const tether::client::Stage stage(vehicle, "work");
      work((1000 + 77 * i) * tenths / 10);
    }
    require(vehicle.command_velocity({.velocity_H_m_s = {}, .yaw_rate_rad_s = 0.3}));
    require(require(vehicle.read<tether::uav::RangeSample>("range")).range_m > 0.0
                ? tether::ok_status()
                : tether::Failure{tether::Failure::Kind::kInvalid, "no range"});
    require(vehicle.annotate("step", "{\"i\": " + std::to_string(i) + "}"));
    require(vehicle.sleep_for(3ms));
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::string mode = argc > 1 ? argv[1] : "";
  if (mode == "native") {
    // The kernel runs it.
    const std::string self = argv[0];
    execl(self.c_str(), self.c_str(), "good", nullptr);
  }
  static Worker worker(100'000);  // never ends
  if (mode == "from_start") worker.wake(0ms);
  Server* const daemon = mode == "daemon" ? &leave_daemon() : nullptr;
  HandOver* const hand_over = mode == "hands_over" ? new HandOver : nullptr;  // never ends
  const auto vehicle = join();
  if (mode == "at_once") worker.wake(0ms);
  if (mode == "meanwhile") worker.wake(20ms);
  if (mode == "process" && std::system("true") != 0) return 4;
  for (int i = 0; i < 30 && hand_over; ++i) {
    hand_over->work_once();
    require(vehicle->sleep_for(3ms));
  }
  const auto before = vehicle->now();
  for (int i = 0; i < 300 && daemon; ++i) daemon->ask();
  // Of 60 million steps.
  if (daemon && vehicle->now() - before < 40ms) {
    std::fprintf(stderr, "counted_sut: the daemon computed in no time\n");
    return 5;
  }
  if (work_on_stack() != 3000) return 6;
  fly(*vehicle, mode == "slower" ? 12 : 10);
  // Meets the worker's next waking.
  if (mode == "meanwhile")
    for (int i = 0; i < 200; ++i) require(vehicle->sleep_for(10ms));
  while (mode == "endless") work(1'000'000);
  require(vehicle->finish(true, "flown", "{}"));
  std::fflush(nullptr);
  std::_Exit(0);
}
