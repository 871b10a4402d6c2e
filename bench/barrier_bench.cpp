// What one interaction costs the barrier alone, with so many SUTs: its arrival, its hold, the bound
// of ST and its release. All SUTs wait for a reply; the next one is released, computes and calls
// again. Counters: allocations of all interactions.

#include <cstdint>

#include <benchmark/benchmark.h>

#include <tether/base/random.h>
#include <tether/base_testing/allocation_count.h>
#include <tether/sync/barrier_synchronizer.h>

namespace {

using namespace tether;
using namespace tether::sync;

constexpr Duration kDt = std::chrono::milliseconds(1);

// Up to 20 ms, from a small generator, so that the draws cost little.
Duration waits(std::uint64_t& state) {
  state = state * 6364136223846793005ULL + 1442695040888963407ULL;
  return Duration(static_cast<std::int64_t>((state >> 33) % 20'000'000));
}

void interaction(benchmark::State& state) {
  BarrierSynchronizer barrier{StepGrid(kDt)};
  const auto suts = static_cast<std::size_t>(state.range(0));
  std::uint64_t random = 1;
  SimTime st{};
  for (SutIndex sut = 0; sut < suts; ++sut) barrier.add(ExecTime{});
  for (SutIndex sut = 0; sut < suts; ++sut) {
    barrier.arrive(sut, ExecTime{}, st);
    barrier.hold({sut, ExecTime(waits(random)), 1});
  }
  long allocations = 0;
  {
    AllocationCount count;
    for ([[maybe_unused]] auto _ : state) {
      auto grant = barrier.release(st);
      if (!grant) {
        st = barrier.lower_bound();
        grant = barrier.release(st);
      }
      barrier.arrive(grant->sut, grant->resume_at, st);
      barrier.hold({grant->sut, grant->resume_at + waits(random), 1});
    }
    allocations = count.stop();
  }
  state.counters["allocations"] = static_cast<double>(allocations);
}
BENCHMARK(interaction)->Arg(2)->Arg(16)->Arg(128)->Arg(1024);

}  // namespace
