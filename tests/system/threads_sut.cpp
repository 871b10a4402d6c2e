// A SUT of several threads: threads_sut MODE SECONDS [CORE]
//
//   count  one thread reads the camera, three count iterations of a fixed kernel, until ET has
//          reached SECONDS; the details of its end say how many per second of ET
//   child  the same with a child process that reads the rangefinder
//   push   subscribes to camera and rangefinder; the details say what came, and whether in time
//
// CORE: run on that core only, so that what else the machine does there is little.
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include <sched.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <tether/client/simulated_vehicle.h>
#include <tether/client/subscription.h>

namespace {

using namespace std::chrono_literals;
using tether::Duration;
using tether::ExecTime;
using tether::client::Vehicle;

[[noreturn]] void fail(const std::string& what) {
  std::fprintf(stderr, "threads_sut: %s\n", what.c_str());
  std::_Exit(3);
}

template <class T>
T require(tether::Result<T> result) {
  if (!result) fail(result.failure().message);
  return std::move(result).value();
}

std::unique_ptr<Vehicle> join() {
  auto options = require(tether::client::options_from_environment());
  options.sut_name = "threads_sut";
  return require(tether::client::connect(std::move(options)));
}

void pin_to(int core) {
  cpu_set_t cores;
  CPU_ZERO(&cores);
  CPU_SET(static_cast<std::size_t>(core), &cores);
  if (sched_setaffinity(0, sizeof cores, &cores) != 0) fail("cannot be pinned to that core");
}

/// A few microseconds of arithmetic that no compiler can leave out.
void work(std::uint64_t& state) {
  for (int i = 0; i < 1000; ++i) state = state * 6364136223846793005u + 1442695040888963407u;
}

Duration process_cpu() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return std::chrono::seconds(t.tv_sec) + Duration(t.tv_nsec);
}

// ---- count

struct Counted {
  std::uint64_t iterations = 0;
  Duration et{0};
  int images = 0;
};

Counted count(Vehicle& vehicle, ExecTime end) {
  std::atomic<bool> over = false;
  std::atomic<std::uint64_t> iterations = 0;
  const ExecTime begin = vehicle.now();
  std::vector<std::thread> counting;
  for (std::uint64_t i = 0; i < 3; ++i) {
    counting.emplace_back([&over, &iterations, state = i]() mutable {
      while (!over) {
        work(state);
        iterations.fetch_add(1, std::memory_order_relaxed);
      }
      if (state == 0) std::puts("a number that is never there");
    });
  }
  Counted counted;
  while (vehicle.now() < end) {
    const auto image = require(vehicle.read_camera("camera"));
    if (image.sampled_at > tether::same_instant(vehicle.now())) fail("an image from the future");
    require(vehicle.command_velocity({}));
    ++counted.images;
  }
  counted.et = vehicle.now() - begin;
  counted.iterations = iterations;
  over = true;
  for (auto& thread : counting) thread.join();
  return counted;
}

std::string details_of(const Counted& counted) {
  return "{\"iterations_per_s\": " +
         std::to_string(static_cast<double>(counted.iterations) / tether::to_seconds(counted.et)) +
         ", \"images\": " + std::to_string(counted.images) +
         ", \"cpu_s\": " + std::to_string(tether::to_seconds(process_cpu())) +
         ", \"et_s\": " + std::to_string(tether::to_seconds(counted.et)) + "}";
}

std::string run_count(Vehicle& vehicle, ExecTime end) {
  return details_of(count(vehicle, end));
}

// ---- child

std::string run_with_child(Vehicle& vehicle, ExecTime end) {
  const pid_t child = fork();
  if (child == 0) {
    const auto own = join();
    while (own->now() < end) {
      require(own->read_range("range"));
      require(own->sleep_for(5ms));
    }
    std::_Exit(0);
  }
  const Counted counted = count(vehicle, end);
  int status = 0;
  if (waitpid(child, &status, 0) != child || status != 0) fail("the child failed");
  return details_of(counted);
}

// ---- push

template <class Sample>
struct Pushed {
  std::atomic<int> count = 0;
  std::atomic<int> lost = 0;
  std::atomic<int> from_the_future = 0;
  std::uint64_t next_index = 0;

  void take(const Sample& sample, ExecTime now) {
    if (count++ > 0 && sample.index != next_index) ++lost;
    next_index = sample.index + 1;
    if (sample.sampled_at > tether::same_instant(now)) ++from_the_future;
  }
  std::string text() const {
    return "{\"count\": " + std::to_string(count) + ", \"lost\": " + std::to_string(lost) +
           ", \"from_the_future\": " + std::to_string(from_the_future) + "}";
  }
};

std::string run_push(Vehicle& vehicle, ExecTime end) {
  Pushed<tether::uav::CameraSample> images;
  Pushed<tether::uav::ImuSample> readings;
  auto camera = require(tether::client::subscribe_camera(
      vehicle, "camera", [&](const auto& image) { images.take(image, vehicle.now()); }));
  auto imu = require(tether::client::subscribe_imu(
      vehicle, "imu", [&](const auto& reading) { readings.take(reading, vehicle.now()); }));
  std::uint64_t state = 1;
  while (vehicle.now() < end) work(state);
  if (camera->ended() || imu->ended()) fail("a subscription has ended");
  camera.reset();
  imu.reset();
  return "{\"camera\": " + images.text() + ", \"imu\": " + readings.text() + "}";
}

const std::map<std::string, std::function<std::string(Vehicle&, ExecTime)>> kModes = {
    {"count", run_count}, {"child", run_with_child}, {"push", run_push}};

}  // namespace

int main(int argc, char** argv) {
  const auto mode = kModes.find(argc > 2 ? argv[1] : "");
  if (mode == kModes.end()) fail("usage: threads_sut MODE SECONDS [CORE]");
  if (argc > 3) pin_to(std::atoi(argv[3]));
  const auto vehicle = join();
  const ExecTime end = vehicle->now() + tether::duration_from_seconds(std::atof(argv[2]));
  const std::string details = mode->second(*vehicle, end);
  std::printf("%s\n", details.c_str());
  require(vehicle->finish(true, "done", details));
  return 0;
}
