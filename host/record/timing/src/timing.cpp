#include <algorithm>
#include <array>
#include <cstdint>
#include <set>
#include <string>
#include <tuple>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <tether/base/error.h>
#include <tether/link/messages.h>
#include <tether/timing/timing.h>

namespace tether::timing {
namespace {

constexpr std::array<std::string_view, kDoubts> kDoubtNames = {"unseen_wait", "parallel_threads",
                                                               "disk_wait",   "stretched_wait",
                                                               "slight_wait", "busy_machine"};

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& subject,
                         const std::string& what) {
  throw Error(ErrorCode::kBadFile, {file.string()}, what).about(subject);
}

/// Without the computing time of a scripted clock, which the stages have.
std::string clock_of(const record::SutInfo& sut) {
  return sut.clock.is_scaled() ? sut.clock.text() : std::string(computer::name(sut.clock.kind));
}

/// Empty: not known.
Build build_of(const Timing& timing, const std::string& uav) {
  const auto found = timing.builds.find(uav);
  return found == timing.builds.end() ? Build() : found->second;
}

}  // namespace

std::string_view name(Doubt::Kind kind) {
  return kDoubtNames[static_cast<std::size_t>(kind)];
}

std::optional<std::string> difference(const Build& was, const Build& is) {
  constexpr std::size_t kMostNamed = 3;
  std::vector<std::string> found;
  const auto value_in = [](const Build& build, const std::string& name) {
    const auto part = std::ranges::find(build, name, &link::BuildPart::name);
    return part == build.end() ? std::string("missing") : fmt::format("\"{}\"", part->value);
  };
  const auto compare = [&](const std::string& name) {
    const std::string old_value = value_in(was, name), new_value = value_in(is, name);
    if (old_value != new_value)
      found.push_back(fmt::format("{} was {}, is {}", name, old_value, new_value));
  };
  for (const link::BuildPart& part : was) compare(part.name);
  for (const link::BuildPart& part : is)
    if (value_in(was, part.name) == "missing") compare(part.name);
  if (found.empty()) return std::nullopt;
  const std::size_t more = found.size() - std::min(found.size(), kMostNamed);
  found.resize(found.size() - more);
  return fmt::format("{}{}", fmt::join(found, "; "),
                     more > 0 ? fmt::format("; and {} more", more) : "");
}

Run run_of(const record::Record& record, const record::SutInfo& sut) {
  Run run{.uav = sut.uav, .seed = record.header.seed, .calls = {}};
  std::string previous = "start";
  ExecTime resumed{};
  for (const auto& [at, order, entry] : record.interactions) {
    if (entry.uav != sut.uav) continue;
    Call call{.call = entry.kind == record::kSensor ? entry.sensor : entry.kind, .stages = {}};
    for (const record::StageTime& time : entry.stages)
      call.stages.push_back({time.stage, time.computing});
    if (call.stages.empty() && !sut.concurrent && entry.request_at > resumed)
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
                .condition = header.condition,
                .program = first.sut,
                .build_id = first.build_id,
                .builds = {},
                .board = header.target ? header.target->name : "host",
                .clock = clock_of(first),
                .recorded_at = recorded_at,
                .counted_ns = {},
                .doubts = {},
                .runs = {}};
  for (const record::SutInfo& sut : header.suts) {
    if (sut.replay)
      refuse(file, sut.uav, "was flown with replayed time. Use the runs whose time was measured.");
    if (sut.sut != first.sut || sut.build_id != first.build_id || clock_of(sut) != timing.clock)
      refuse(file, sut.uav,
             fmt::format("has SUTs that differ: \"{}\" and \"{}\". All must be one program with "
                         "one clock.",
                         first.sut, sut.sut));
    for (const record::BuildPart& part : sut.build)
      timing.builds[sut.uav].push_back({part.name, part.value});
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
  if (timing.clock != computer::name(computer::ClockKind::kCounted))
    refuse(file, timing.clock,
           fmt::format("is of runs under the clock \"{}\", but counted work is needed. Fly under a "
                       "counted target, and write its timing.",
                       timing.clock));
}

void add(Timing& timing, const Doubt& doubt) {
  const auto known = std::ranges::find_if(timing.doubts, [&](const Doubt& one) {
    return one.kind == doubt.kind && one.subject == doubt.subject;
  });
  if (known == timing.doubts.end())
    timing.doubts.push_back(doubt);
  else
    known->amount = std::max(known->amount, doubt.amount);
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
    if (const auto other = difference(build_of(timing, run.uav), build_of(more, run.uav)))
      refuse(
          file, run.uav,
          fmt::format("has another program of UAV \"{}\" than the files before it: {}. Give only "
                      "runs of one program with the same arguments, files and libraries.",
                      run.uav, *other));
    const auto is_same = [&](const Run& own) { return own.uav == run.uav && own.seed == run.seed; };
    if (std::ranges::any_of(timing.runs, is_same))
      refuse(
          file, "seed",
          fmt::format("has seed {} of UAV \"{}\" again. Give each run once.", run.seed, run.uav));
    timing.runs.push_back(run);
  }
  for (const Doubt& doubt : more.doubts) add(timing, doubt);
  if (more.condition != timing.condition) timing.condition.clear();
  timing.recorded_at = std::max(timing.recorded_at, more.recorded_at);
}

bool is_between_calls(const Timing& timing, const std::string& stage) {
  for (const Run& run : timing.runs) {
    std::string previous = "start";
    for (const Call& call : run.calls) {
      if (link::stage_between(previous, call.call) == stage) return true;
      previous = call.call;
    }
  }
  return false;
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
