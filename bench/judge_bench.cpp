// What it costs to judge 1,000 clauses over a record of ten minutes, with a ground truth every
// 10 ms. At most 1 s is allowed. The yardstick reads every value once for each clause.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include <tether/judge/judge.h>
#include <tether/mission/mission.h>
#include <tether/record/reader.h>
#include <tether/toml/table.h>

namespace {

using namespace tether;
using namespace std::chrono_literals;

constexpr int kClauses = 1'000;
constexpr std::size_t kInstants = 60'000;

/// Every 10 ms.
std::vector<double> ten_minutes() {
  std::vector<double> values;
  for (std::size_t i = 0; i < kInstants; ++i) {
    const double t_s = 0.01 * static_cast<double>(i);
    values.push_back(1.5 + std::sin(t_s) + 0.1 * std::sin(97.0 * t_s));
  }
  return values;
}

void yardstick(benchmark::State& state) {
  const std::vector<double> values = ten_minutes();
  for (auto _ : state) {
    for (int clause = 0; clause < kClauses; ++clause) {
      double least = std::numeric_limits<double>::infinity();
      for (const double value : values) least = std::min(least, value);
      benchmark::DoNotOptimize(least);
    }
  }
}

/// A flight of ten minutes at 10 ms, whose program reads an image and sends a command every 33 ms.
record::Record flight() {
  record::Record record;
  record.header.policy = record::kConservativeBarrier;
  record.header.sensors.emplace_back().uav = "uav1";
  record.header.sensors.back().name = record.header.sensors.back().kind = "camera";
  const std::vector<double> heights_m = ten_minutes();
  const SimTime last(static_cast<std::int64_t>(kInstants - 1) * 10ms);
  for (std::size_t i = 0; i < kInstants; ++i) {
    record::GroundTruth truth;
    truth.uav = "uav1";
    truth.at = SimTime(static_cast<std::int64_t>(i) * 10ms);
    truth.p_WB_m[2] = heights_m[i];
    record.ground_truth.push_back({truth.at, 0, truth});
  }
  for (SimTime at; at < last - 33ms; at += 33ms) {
    record::Interaction call;
    call.uav = "uav1";
    call.kind = record::kSensor;
    call.sensor = "camera";
    call.request_at = same_instant(at);
    call.reply_at = same_instant(at + 5ms);
    call.sampled_at = at;
    record.interactions.push_back({at, 0, call});
    call.kind = record::kCommand;
    call.request_at = call.reply_at = same_instant(at + 20ms);
    call.effect_at = at + 21ms;
    record.interactions.push_back({at, 0, call});
  }
  record.footer.emplace().st_at_end = last;
  return record;
}

/// All clauses have that text, but each its own bound.
void judge_mission(benchmark::State& state, const std::string& clause, const std::string& end) {
  std::string text = "[[task]]\ntask = \"hold\"\n";
  for (int i = 0; i < kClauses; ++i)
    text += "[[clause]]\n" + clause + std::to_string(1.0 + 0.001 * i) + end;
  const mission::Mission mission =
      mission::read_mission(toml::Document::parse(text, "bench.toml").root());
  const record::Record record = flight();
  for (auto _ : state) benchmark::DoNotOptimize(judge::judge(mission, "uav1", record));
}
BENCHMARK_CAPTURE(judge_mission, always, "always = \"altitude <= ", " m\"\n")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(judge_mission, always_in_95_percent, "always = \"altitude <= ", " m in 95 %\"\n")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(judge_mission, eventually_for_5_s,
                  "for_s = 5\neventually = \"altitude <= ", " m\"\n")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(judge_mission, reaction, "always = \"reaction_time <= ", " s in 95 %\"\n")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(judge_mission, deadline, "name = \"", "\"\nwithin_s = 700\n")
    ->Unit(benchmark::kMillisecond);

BENCHMARK(yardstick)->Unit(benchmark::kMillisecond);

}  // namespace
