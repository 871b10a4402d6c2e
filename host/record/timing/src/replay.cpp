#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <tether/base/error.h>
#include <tether/base/random.h>
#include <tether/link/codec.h>
#include <tether/stats/sample_statistics.h>
#include <tether/timing/replay.h>

namespace tether::timing {

using computer::ReplayMode;
using computer::UnknownStages;
namespace {

[[noreturn]] void refuse(const std::string& subject, const std::string& what) {
  throw Error(ErrorCode::kBadFile, what).about(subject);
}

std::string names_of(const std::vector<link::StageTime>& stages) {
  std::vector<std::string> names;
  for (const link::StageTime& time : stages) names.push_back(fmt::format("\"{}\"", time.stage));
  return fmt::format("{}", fmt::join(names, ", "));
}

const std::vector<Call>& calls_of(const Timing& timing, const std::string& uav,
                                  std::uint64_t seed) {
  std::vector<std::string> seeds;
  for (const Run& run : timing.runs) {
    if (run.uav != uav) continue;
    if (run.seed == seed) return run.calls;
    seeds.push_back(std::to_string(run.seed));
  }
  refuse(uav, fmt::format("has no run of UAV \"{}\" with seed {} for an exact replay. It has the "
                          "seeds {}. Use one of them, or mode = \"resampled\".",
                          uav, seed, fmt::join(seeds, ", ")));
}

/// Counted work of the new build / of the one that was recorded.
double ratio_of(const std::string& stage, const Timing& timing,
                const std::map<std::string, std::vector<double>>& counted) {
  const auto old_work = timing.counted_ns.find(stage);
  const auto new_work = counted.find(stage);
  // A stage that the new build no longer has is not charged.
  if (new_work == counted.end()) return 1.0;
  if (old_work == timing.counted_ns.end())
    refuse(stage, fmt::format("has no counted work of stage \"{}\". Write it with: tether timing "
                              "RECORD... --counted RECORD --out FILE",
                              stage));
  return old_work->second > 0.0 ? stats::mean(new_work->second) / old_work->second : 1.0;
}

Build with_id(const std::string& build_id, Build build) {
  build.insert(build.begin(), {"the program's build id", build_id});
  return build;
}

}  // namespace

Replay::Replay(const Timing& timing, const ReplaySetting& setting, const std::string& uav,
               std::uint64_t seed)
    : unknown_(setting.unknown), uav_(uav), seed_(seed) {
  if (std::ranges::none_of(timing.runs, [&](const Run& run) { return run.uav == uav; }))
    refuse(uav, fmt::format("has no run of UAV \"{}\".", uav));
  for (auto& [stage, times] : samples_of(timing, uav)) sources_[stage].times_ns = times;
  if (setting.mode == ReplayMode::kExact) {
    if (timing.build_id.empty())
      refuse("build_id",
             "names no build id, which an exact replay needs. Link the program with "
             "--build-id and record it again, or use mode = \"resampled\".");
    const auto build = timing.builds.find(uav);
    if (build == timing.builds.end())
      refuse("build",
             "does not have the program's arguments, files and libraries, which an exact replay "
             "compares: it is of an earlier version of Tether. Record the runs again, or use mode "
             "= \"resampled\".");
    calls_ = calls_of(timing, uav, seed);
    required_ = with_id(timing.build_id, build->second);
  } else if (setting.counted) {
    const auto counted = samples_of(*setting.counted, uav);
    if (setting.mode == ReplayMode::kScaled)
      for (auto& [stage, source] : sources_) source.factor = ratio_of(stage, timing, counted);
    for (const auto& [stage, times] : counted)
      if (unknown_ == UnknownStages::kCounted && !knows(stage)) counted_[stage].times_ns = times;
  }
  for (auto* sources : {&sources_, &counted_})
    for (auto& [stage, source] : *sources) source.factor *= setting.slowdown;
  if (const std::size_t stages = sources_.size() + counted_.size(); stages > link::kMaxStages)
    refuse(uav, fmt::format("has too many stages ({}). At most {} are allowed.", stages,
                            link::kMaxStages));
  give();
}

void Replay::give() {
  given_.clear();
  if (required_) {
    if (next_ < calls_.size()) given_ = calls_[next_].stages;
    return;
  }
  for (const auto* sources : {&sources_, &counted_})
    for (const auto& [stage, source] : *sources) given_.push_back({stage, draw(stage, source)});
}

Duration Replay::draw(const std::string& stage, const Source& source) const {
  KeyedRandom random({seed_, random_stream(uav_, stage, "timing"), source.index});
  const auto count = static_cast<double>(source.times_ns.size());
  const auto place = static_cast<std::size_t>(random.uniform() * count);
  return Duration(std::llround(source.times_ns[place] * source.factor));
}

std::optional<std::string> Replay::other_build(const std::string& build_id,
                                               const Build& build) const {
  return required_ ? timing::difference(*required_, with_id(build_id, build)) : std::nullopt;
}

std::optional<std::string> Replay::take(const std::string& call,
                                        const std::vector<link::StageTime>& stages) {
  if (auto found = difference(call, stages)) return found;
  ++next_;
  for (const link::StageTime& time : stages) {
    for (auto* sources : {&sources_, &counted_})
      if (const auto source = sources->find(time.stage); source != sources->end())
        ++source->second.index;
  }
  give();
  return std::nullopt;
}

std::optional<std::string> Replay::difference(const std::string& call,
                                              const std::vector<link::StageTime>& stages) const {
  if (required_) {
    if (next_ >= calls_.size())
      return fmt::format("call {} (\"{}\"): the recorded run ended after {} calls", next_ + 1, call,
                         calls_.size());
    const Call& expected = calls_[next_];
    const auto same = [](const auto& a, const auto& b) { return a.stage == b.stage; };
    if (expected.call != call || !std::ranges::equal(expected.stages, stages, same))
      return fmt::format("call {}: expected \"{}\" after stage {}, found \"{}\" after {}",
                         next_ + 1, expected.call, names_of(expected.stages), call,
                         names_of(stages));
  }
  for (const link::StageTime& time : stages) {
    const auto given = std::ranges::find(given_, time.stage, &link::StageTime::stage);
    const bool is_given = given != given_.end();
    if (!is_given && unknown_ != UnknownStages::kZero)
      return fmt::format("call {} (\"{}\"): stage \"{}\" is not in the timing file{}", next_ + 1,
                         call, time.stage,
                         unknown_ == UnknownStages::kCounted ? ", nor in the counted one" : "");
    if (time.computing != (is_given ? given->computing : Duration(0)))
      return fmt::format("call {} (\"{}\"): stage \"{}\" took {} ns instead of the {} ns given",
                         next_ + 1, call, time.stage, time.computing.count(),
                         is_given ? given->computing.count() : 0);
  }
  return std::nullopt;
}

}  // namespace tether::timing
