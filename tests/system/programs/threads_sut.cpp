// A SUT of several threads: threads_sut MODE SECONDS [CORE]
//
//   count  one thread reads the camera, three count iterations of a fixed kernel, until ET has
//          reached SECONDS; the details of its end have the number per second of ET
//   apart  the same with a child process that has left the process group and computes; it must not
//          get more CPU time than ET passes
//   spawn  the same while a thread starts one program after another
//
// CORE: run on that core only, before everything else there if that is allowed, so that little of
// what the machine does otherwise is felt.
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include <sched.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <tether/client/simulated_vehicle.h>

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

void take(int core) {
  cpu_set_t cores;
  CPU_ZERO(&cores);
  CPU_SET(static_cast<std::size_t>(core), &cores);
  if (sched_setaffinity(0, sizeof cores, &cores) != 0) fail("cannot be pinned to that core");
  setpriority(PRIO_PROCESS, 0, -20);
}

/// A few microseconds of arithmetic that no compiler can leave out.
void work(std::uint64_t& state) {
  for (int i = 0; i < 1000; ++i) state = state * 6364136223846793005u + 1442695040888963407u;
}

/// How long the calling thread has run, and how long it could have run but for others on its core
/// (Linux, Documentation/scheduler/sched-stats.rst).
struct Scheduled {
  Duration ran{0};
  Duration delayed{0};
};
Scheduled scheduled() {
  const std::string path = "/proc/self/task/" + std::to_string(gettid()) + "/schedstat";
  std::ifstream file(path);
  std::int64_t ran_ns = 0;
  std::int64_t delayed_ns = 0;
  if (!(file >> ran_ns >> delayed_ns)) fail(path + " cannot be read");
  return {Duration(ran_ns), Duration(delayed_ns)};
}

// ---- count

/// What one thread counted, and over which time.
struct Counted {
  std::uint64_t iterations = 0;
  Duration et{0};
  Scheduled scheduled;
};

Counted count_until(const Vehicle& vehicle, const std::atomic<bool>& over, std::uint64_t state) {
  Counted counted;
  const Scheduled before = scheduled();
  const ExecTime begin = vehicle.now();
  for (; !over; ++counted.iterations) work(state);
  counted.et = vehicle.now() - begin;
  const Scheduled after = scheduled();
  counted.scheduled = {after.ran - before.ran, after.delayed - before.delayed};
  if (state == 0) std::puts("a number that is never there");
  return counted;
}

std::string details_of(const std::vector<Counted>& threads, int images) {
  Counted sum;
  for (const Counted& counted : threads) {
    sum.iterations += counted.iterations;
    sum.et += counted.et;
    sum.scheduled.ran += counted.scheduled.ran;
    sum.scheduled.delayed += counted.scheduled.delayed;
  }
  const auto text = [](Duration d) { return std::to_string(tether::to_seconds(d)); };
  return "{\"iterations\": " + std::to_string(sum.iterations) + ", \"et_s\": " + text(sum.et) +
         ", \"ran_s\": " + text(sum.scheduled.ran) +
         ", \"delayed_s\": " + text(sum.scheduled.delayed) +
         ", \"images\": " + std::to_string(images) + "}";
}

std::string run_count(Vehicle& vehicle, ExecTime end) {
  std::atomic<bool> over = false;
  std::vector<Counted> counted(3);
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < counted.size(); ++i) {
    threads.emplace_back([&, i] { counted[i] = count_until(vehicle, over, i); });
  }
  int images = 0;
  for (; vehicle.now() < end; ++images) {
    const auto image = require(vehicle.read<tether::uav::CameraSample>("camera"));
    if (image.sampled_at > tether::same_instant(vehicle.now())) fail("an image from the future");
    require(vehicle.command_velocity({}));
  }
  over = true;
  for (auto& thread : threads) thread.join();
  return details_of(counted, images);
}

// ---- apart

Duration own_cpu_time() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
}

/// The child's life: half as much again would be more than any stop takes.
[[noreturn]] void compute_apart(ExecTime end) {
  setsid();
  const auto own = join();
  const ExecTime begin = own->now();
  const Duration before = own_cpu_time();
  std::uint64_t state = 1;
  while (own->now() < end) work(state);
  const Duration charged = own->now() - begin;
  if (2 * (own_cpu_time() - before) > 3 * charged) fail("computed while it should be stopped");
  std::_Exit(0);
}

std::string run_beside_one_apart(Vehicle& vehicle, ExecTime end) {
  const pid_t child = fork();
  if (child == 0) compute_apart(end);
  while (vehicle.now() < end) require(vehicle.command_velocity({}));
  int status = 0;
  if (waitpid(child, &status, 0) != child || status != 0) fail("the child failed");
  return "{}";
}

// ---- spawn

/// Starts `true` again and again; returns how often.
int spawn_until(const std::atomic<bool>& over) {
  char name[] = "true";
  char* const arguments[] = {name, nullptr};
  int count = 0;
  for (; !over; ++count) {
    pid_t child = 0;
    int status = 0;
    if (posix_spawnp(&child, name, nullptr, nullptr, arguments, environ) != 0) fail("no child");
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (status != 0) fail("the child failed");
  }
  return count;
}

std::string run_with_spawning(Vehicle& vehicle, ExecTime end) {
  std::atomic<bool> over = false;
  int count = 0;
  std::thread spawning([&] { count = spawn_until(over); });
  while (vehicle.now() < end) {
    require(vehicle.read<tether::uav::RangeSample>("range"));
    require(vehicle.sleep_for(2ms));
  }
  over = true;
  spawning.join();
  return "{\"started\": " + std::to_string(count) + "}";
}

const std::map<std::string, std::function<std::string(Vehicle&, ExecTime)>> kModes = {
    {"count", run_count}, {"apart", run_beside_one_apart}, {"spawn", run_with_spawning}};

}  // namespace

int main(int argc, char** argv) {
  const auto mode = kModes.find(argc > 2 ? argv[1] : "");
  if (mode == kModes.end()) fail("usage: threads_sut MODE SECONDS [CORE]");
  if (argc > 3) take(std::atoi(argv[3]));
  const auto vehicle = join();
  const ExecTime end = vehicle->now() + tether::duration_from_seconds(std::atof(argv[2]));
  const std::string details = mode->second(*vehicle, end);
  std::printf("%s\n", details.c_str());
  require(vehicle->finish(true, "done", details));
  return 0;
}
