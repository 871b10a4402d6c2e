// What reading a SUT's CPU clock takes, in wall time and in charged ET, without child processes
// and with some that wait. Counters: the medians [us], and ratios to reading the CPU clock of
// the process by clock_gettime, in turns with it.

#include <algorithm>
#include <chrono>
#include <functional>
#include <vector>

#include <benchmark/benchmark.h>
#include <signal.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <tether/client/sut_clock.h>

namespace {

using namespace tether;

double clock_us(clockid_t clock) {
  timespec t{};
  ::clock_gettime(clock, &t);
  return static_cast<double>(t.tv_sec) * 1e6 + static_cast<double>(t.tv_nsec) * 1e-3;
}

double time_us(const std::function<void()>& work) {
  const double begin = clock_us(CLOCK_MONOTONIC);
  work();
  return clock_us(CLOCK_MONOTONIC) - begin;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Child processes that wait for a signal.
class IdleChildren {
 public:
  explicit IdleChildren(std::int64_t count) {
    for (std::int64_t i = 0; i < count; ++i) {
      children_.push_back(::fork());
      if (children_.back() == 0)
        while (true) ::pause();
    }
  }
  ~IdleChildren() {
    for (const pid_t child : children_) {
      ::kill(child, SIGKILL);
      ::waitpid(child, nullptr, 0);
    }
  }
  IdleChildren(const IdleChildren&) = delete;
  IdleChildren& operator=(const IdleChildren&) = delete;

 private:
  std::vector<pid_t> children_;
};

/// The pair of readings that an interaction makes. Argument: the number of child processes.
void interaction(benchmark::State& state) {
  const IdleChildren children(state.range(0));
  const auto source = client::make_cpu_source(1.0);
  client::SutClock clock(*source);
  std::vector<double> yardstick_us, interaction_us, charged_us;
  for ([[maybe_unused]] auto _ : state) {
    yardstick_us.push_back(time_us([] { clock_us(CLOCK_PROCESS_CPUTIME_ID); }));
    const auto interact = [&clock] {
      const ExecTime stamp = clock.hold();
      clock.resume(stamp);
      return stamp;
    };
    interaction_us.push_back(time_us(interact));
    const ExecTime first = interact(), second = interact();
    charged_us.push_back(to_seconds(second - first) * 1e6);
  }
  state.counters["yardstick_us"] = median(yardstick_us);
  state.counters["interaction_us"] = median(interaction_us);
  state.counters["ratio"] = median(interaction_us) / median(yardstick_us);
  state.counters["charged_ratio"] = median(charged_us) / median(yardstick_us);
}

BENCHMARK(interaction)->Arg(0)->Arg(1)->Arg(8)->Iterations(2'000);

}  // namespace
