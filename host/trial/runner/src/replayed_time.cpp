#include "replayed_time.h"

#include <utility>

#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/link/messages.h>
#include <tether/timing/timing.h>

namespace tether::runner {
namespace {

timing::Timing read(const std::filesystem::path& file, const scenario::Scenario& scenario) {
  timing::Timing timing = timing::read_timing(file);
  timing::require_scenario(timing, scenario.name, file);
  return timing;
}

class Giver final : public coordinator::GivenTime {
 public:
  explicit Giver(timing::Replay replay) : replay_(std::move(replay)) {}

  std::optional<std::string> other_build(const link::Hello& hello) const override {
    return replay_.other_build(hello.build_id, hello.build);
  }
  std::vector<link::StageTime> given() const override { return replay_.given(); }
  std::optional<std::string> take(const std::string& call,
                                  const std::vector<link::StageTime>& stages) override {
    return replay_.take(call, stages);
  }
  bool knows(const std::string& stage) const override { return replay_.knows(stage); }

 private:
  timing::Replay replay_;
};

bool is_library(const link::BuildPart& part) {
  return part.name.starts_with(timing::kLibraryPart);
}

}  // namespace

std::vector<Warning> of_other_arguments(const ReplayedTime& time, const record::Header& header) {
  std::vector<Warning> warnings;
  for (const record::SutInfo& sut : header.suts) {
    const auto was = time.arguments.find(sut.uav);
    if (was == time.arguments.end()) continue;
    timing::Build is;
    for (const record::BuildPart& part : sut.build) is.push_back({part.name, part.value});
    std::erase_if(is, is_library);
    if (const auto other = timing::difference(was->second, is))
      warnings.push_back({Consequence::kDoubtful,
                          {},
                          fmt::format("the time of UAV '{}'", sut.uav),
                          fmt::format("was recorded with other arguments or files ({})", *other)});
  }
  return warnings;
}

std::function<std::unique_ptr<coordinator::GivenTime>()> giver_of(const timing::Replay& replay) {
  return [replay] { return std::make_unique<Giver>(replay); };
}

ReplayedTime replayed_time(const TrialSpec& spec) {
  ReplayedTime time;
  if (!spec.condition.replay) return time;
  const scenario::ReplaySource& source = *spec.condition.replay;
  const timing::Timing timing = read(source.timing, spec.scenario);
  timing::ReplaySetting setting{.mode = source.mode,
                                .unknown = source.unknown,
                                .counted = {},
                                .slowdown = spec.condition.slowdown};
  if (!source.counted.empty()) {
    setting.counted = read(source.counted, spec.scenario);
    timing::require_counted(*setting.counted, source.counted);
  }
  try {
    for (const scenario::UavSetup& uav : spec.scenario.uavs)
      time.replays.emplace_back(timing, setting, uav.placement.name, spec.seed);
  } catch (const Error& e) {
    throw Error(e.code(), {source.timing.string()}, e.what()).about(e.subject());
  }
  time.from = {.timing = source.timing.filename().string(),
               .mode = std::string(computer::kReplayModes[static_cast<std::size_t>(setting.mode)]),
               .recorded_at = timing.recorded_at,
               .board = timing.board,
               .build_id = timing.build_id};
  time.has_waits = timing.clock.starts_with(computer::name(computer::ClockKind::kWall));
  for (campaign::Doubt doubt : timing.doubts) {
    doubt.recorded_in = time.from.timing;
    if (doubt.subject.empty()) doubt.subject = timing.board;
    time.doubts.push_back(std::move(doubt));
  }
  if (setting.mode == computer::ReplayMode::kResampled) {
    time.arguments = timing.builds;
    for (auto& [uav, parts] : time.arguments) std::erase_if(parts, is_library);
  }
  if (setting.mode != computer::ReplayMode::kExact)
    time.warnings = timing::warnings(timing::stage_rows(timing));
  for (std::string& warning : time.warnings)
    warning = fmt::format("{}: {}", source.timing.string(), warning);
  return time;
}

}  // namespace tether::runner
