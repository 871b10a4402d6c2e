// What it costs to judge 1,000 clauses over a record of ten minutes, with a ground truth every
// 10 ms. At most 1 s is allowed. The yardstick reads every value once for each clause.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <benchmark/benchmark.h>

#include <tether/stl/robustness.h>

namespace {

using namespace tether;
using namespace std::chrono_literals;

constexpr int kClauses = 1'000;
constexpr std::size_t kInstants = 60'000;

stl::Trace ten_minutes() {
  stl::Trace trace;
  trace.signals.push_back({"m", {}});
  for (std::size_t i = 0; i < kInstants; ++i) {
    trace.at.emplace_back(static_cast<std::int64_t>(i) * 10ms);
    const double t_s = 0.01 * static_cast<double>(i);
    trace.signals[0].values.push_back(1.5 + std::sin(t_s) + 0.1 * std::sin(97.0 * t_s));
  }
  return trace;
}

void judge(benchmark::State& state, const stl::Formula& formula) {
  const stl::Trace trace = ten_minutes();
  for (auto _ : state) {
    stl::Evaluator evaluator(trace);
    for (int clause = 0; clause < kClauses; ++clause)
      benchmark::DoNotOptimize(evaluator.robustness_at(formula, 0));
  }
}

void yardstick(benchmark::State& state) {
  const stl::Trace trace = ten_minutes();
  for (auto _ : state) {
    for (int clause = 0; clause < kClauses; ++clause) {
      double least = std::numeric_limits<double>::infinity();
      for (const double value : trace.signals[0].values) least = std::min(least, value);
      benchmark::DoNotOptimize(least);
    }
  }
}

const stl::Formula kCondition = stl::Formula::at_least(0, 0.3);

BENCHMARK(yardstick)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(judge, always, stl::Formula::always({}, kCondition))
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(judge, eventually_for_5_s,
                  stl::Formula::eventually({}, stl::Formula::always({0s, 5s}, kCondition)))
    ->Unit(benchmark::kMillisecond);

}  // namespace
