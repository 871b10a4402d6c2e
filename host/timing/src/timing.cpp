#include <algorithm>
#include <cstdint>
#include <set>
#include <string>
#include <tuple>

#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/link/messages.h>
#include <tether/timing/timing.h>

namespace tether::timing {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& subject,
                         const std::string& what) {
  throw Error(ErrorCode::kBadFile, {file.string()}, what).about(subject);
}

std::string clock_of(const record::SutInfo& sut) {
  if (sut.cpu_factor != 1.0) return fmt::format("{}*{}", sut.clock, sut.cpu_factor);
  return sut.clock;
}

}  // namespace

Run run_of(const record::Record& record, const record::SutInfo& sut) {
  Run run{.uav = sut.uav, .seed = record.header.seed, .calls = {}};
  std::string previous = "start";
  ExecTime resumed{};
  for (const auto& [at, order, entry] : record.interactions) {
    if (entry.uav != sut.uav) continue;
    Call call{.call = entry.kind == record::kSensor ? entry.sensor : entry.kind, .stages = {}};
    for (const record::StageTime& time : entry.stages)
      call.stages.push_back({time.stage, time.computing});
    if (call.stages.empty() && !sut.concurrent)
      call.stages.push_back({link::stage_between(previous, call.call), entry.request_at - resumed});
    previous = call.call;
    resumed = entry.reply_at;
    run.calls.push_back(std::move(call));
  }
  return run;
}

Timing of_record(const record::Record& record, const std::filesystem::path& file,
                 const std::string& recorded_at) {
  const record::Header& header = record.header;
  if (header.policy != record::kConservativeBarrier)
    refuse(file, "policy",
           "was flown without synchronisation, so it has no computing times. Use a run with policy "
           "= \"conservative_barrier\".");
  if (header.suts.empty()) refuse(file, "suts", "has no SUT.");
  const record::SutInfo& first = header.suts.front();
  Timing timing{.scenario = header.scenario,
                .program = first.sut,
                .build_id = first.build_id,
                .board = header.target ? header.target->name : "host",
                .clock = clock_of(first),
                .recorded_at = recorded_at,
                .counted_ns = {},
                .runs = {}};
  for (const record::SutInfo& sut : header.suts) {
    if (sut.replay)
      refuse(file, sut.uav, "was flown with replayed time. Use the runs whose time was measured.");
    if (sut.sut != first.sut || sut.build_id != first.build_id || clock_of(sut) != timing.clock)
      refuse(file, sut.uav,
             fmt::format("has SUTs that differ: \"{}\" and \"{}\". All must be one program with "
                         "one clock.",
                         first.sut, sut.sut));
    timing.runs.push_back(run_of(record, sut));
  }
  return timing;
}

std::string runs_text(const Timing& timing) {
  std::set<std::string> uavs;
  std::set<std::uint64_t> seeds;
  for (const Run& run : timing.runs) {
    uavs.insert(run.uav);
    seeds.insert(run.seed);
  }
  return fmt::format("{} run{}{}", seeds.size(), seeds.size() == 1 ? "" : "s",
                     uavs.size() > 1 ? fmt::format(" of {} UAVs", uavs.size()) : "");
}

void require_scenario(const Timing& timing, const std::string& scenario,
                      const std::filesystem::path& file) {
  if (timing.scenario != scenario)
    refuse(file, timing.scenario,
           fmt::format("is of the scenario \"{}\", not of \"{}\". Record this scenario, and write "
                       "a file of its own.",
                       timing.scenario, scenario));
}

void require_counted(const Timing& timing, const std::filesystem::path& file) {
  if (timing.clock != link::name(link::ClockKind::kCounted))
    refuse(file, timing.clock,
           fmt::format("is of runs under the clock \"{}\", but counted work is needed. Fly under a "
                       "counted target, and write its timing.",
                       timing.clock));
}

void add(Timing& timing, const Timing& more, const std::filesystem::path& file) {
  const std::tuple<const char*, const std::string&, const std::string&> same[] = {
      {"scenario", timing.scenario, more.scenario},
      {"program", timing.program, more.program},
      {"build id", timing.build_id, more.build_id},
      {"target", timing.board, more.board},
      {"clock", timing.clock, more.clock}};
  for (const auto& [what, own, other] : same)
    if (own != other)
      refuse(file, what,
             fmt::format("has another {} (\"{}\") than the files before it (\"{}\"). Give only "
                         "runs of one program in one scenario on one machine.",
                         what, other, own));
  for (const Run& run : more.runs) {
    const auto is_same = [&](const Run& own) { return own.uav == run.uav && own.seed == run.seed; };
    if (std::ranges::any_of(timing.runs, is_same))
      refuse(
          file, "seed",
          fmt::format("has seed {} of UAV \"{}\" again. Give each run once.", run.seed, run.uav));
    timing.runs.push_back(run);
  }
  timing.recorded_at = std::max(timing.recorded_at, more.recorded_at);
}

std::map<std::string, std::vector<double>> samples_of(const Timing& timing,
                                                      const std::string& uav) {
  std::map<std::string, std::vector<double>> samples;
  for (const Run& run : timing.runs) {
    if (!uav.empty() && run.uav != uav) continue;
    for (const Call& call : run.calls)
      for (const link::StageTime& time : call.stages)
        samples[time.stage].push_back(static_cast<double>(time.computing.count()));
  }
  return samples;
}

}  // namespace tether::timing
