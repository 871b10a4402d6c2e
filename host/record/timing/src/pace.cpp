#include "board_pace.h"

#include <algorithm>
#include <map>
#include <numeric>

#include <fmt/format.h>

#include <tether/stats/sample_statistics.h>
#include <tether/timing/pace.h>
#include <tether/timing/timing.h>

namespace tether::timing {
namespace {

constexpr double kNearlyEvery = 0.95;
constexpr double kLate = 1.5;        // periods of the camera between two images
constexpr double kHardlyEver = 0.1;  // share of the time
constexpr Duration kNoTime = std::chrono::microseconds(10);

double quantile(std::vector<double> values, double share) {
  std::ranges::sort(values);
  return stats::quantile(values, share);
}

/// What happened between two images of one camera.
struct Intervals {
  std::optional<double> offered_hz{};
  std::size_t images = 0;
  std::optional<ExecTime> previous;
  double cost_s = 0.0, waited_s = 0.0;  ///< since the previous image
  std::vector<double> between_s, costs_s;
  double all_costs_s = 0.0, all_waited_s = 0.0;  ///< of the images in `costs_s`
  double behind_s = 0.0;  ///< in which images came late because the SUT computed for too long

  void take_image(ExecTime at) {
    ++images;
    if (previous) {
      between_s.push_back(to_seconds(at - *previous));
      if (offered_hz && cost_s * *offered_hz > 1.0 && between_s.back() * *offered_hz > kLate)
        behind_s += between_s.back();
      costs_s.push_back(cost_s);
      all_costs_s += cost_s;
      all_waited_s += waited_s;
    }
    previous = at;
    cost_s = waited_s = 0.0;
  }
  /// The run ended while the newest image was computed: known is how long that takes at least,
  /// which says something only if no other took longer.
  void end(ExecTime at) {
    if (previous && (costs_s.empty() || cost_s > std::ranges::max(costs_s))) {
      take_image(at);
      --images;
    }
  }
};

/// What the SUT computed after its last call, if it still did so when the run ended.
void add_open_call(const record::Record& record, const record::SutInfo& sut, Run& run) {
  if (!record.footer || std::ranges::count(record.footer->computing, sut.uav) == 0) return;
  const auto& suts = record.header.suts;
  const auto index = static_cast<std::size_t>(
      std::ranges::find(suts, sut.uav, &record::SutInfo::uav) - suts.begin());
  if (index >= record.footer->et_at_end.size()) return;
  ExecTime resumed{};
  for (const auto& logged : record.interactions)
    if (logged.message.uav == sut.uav) resumed = logged.message.reply_at;
  const std::string previous = run.calls.empty() ? "start" : run.calls.back().call;
  const Duration computing = record.footer->et_at_end[index] - resumed;
  if (computing > Duration(0))
    run.calls.push_back({"end", {{link::stage_between(previous, "end"), computing}}});
}

// The same image read again, or none, is no image.
bool is_image(const record::Interaction& entry, std::map<std::string, std::uint64_t>& newest) {
  if (!entry.sampled_at) return false;
  const auto [at, is_first] = newest.try_emplace(entry.sensor, entry.sample_index);
  if (!is_first && at->second == entry.sample_index) return false;
  at->second = entry.sample_index;
  return true;
}

std::map<std::string, Intervals> intervals_of(const record::Record& record, const std::string& uav,
                                              const Run& run) {
  std::map<std::string, Intervals> cameras;
  for (const record::SensorInfo& info : record.header.sensors)
    if (info.uav == uav && info.kind.ends_with("camera") && cameras.try_emplace(info.name).second &&
        info.periodic && info.period > Duration{0})
      cameras[info.name].offered_hz = 1.0 / to_seconds(info.period);
  std::map<std::string, std::uint64_t> newest;
  auto call = run.calls.begin();
  ExecTime resumed{};
  for (const auto& logged : record.interactions) {
    const record::Interaction& entry = logged.message;
    if (entry.uav != uav) continue;
    double cost_s = 0.0, waited_s = 0.0;
    for (const auto& time : call->stages) cost_s += to_seconds(time.computing);
    if (entry.computed) {  // on a shared board
      cost_s = to_seconds(entry.request_at - resumed);
      waited_s = to_seconds(entry.request_at - resumed - *entry.computed);
    }
    resumed = entry.reply_at;
    ++call;
    for (auto& [name, intervals] : cameras) {
      intervals.cost_s += cost_s;
      intervals.waited_s += waited_s;
    }
    const auto camera = cameras.find(entry.sensor);
    if (camera != cameras.end() && is_image(entry, newest))
      camera->second.take_image(entry.reply_at);
  }
  if (call == run.calls.end()) return cameras;
  for (auto& [name, intervals] : cameras) {
    intervals.cost_s += to_seconds(call->stages.front().computing);
    intervals.end(resumed + call->stages.front().computing);
  }
  return cameras;
}

/// Until when a program that sent its last set-point at `last` should have sent more: it asks its
/// flight controller for something else, such as a landing, or ends.
SimTime end_of_setpoints(const record::Record& record, const std::string& uav, SimTime last) {
  for (const auto& logged : record.autopilot) {
    const record::AutopilotMessage& m = logged.message;
    if (m.uav == uav && m.to_controller && m.sent_at >= last &&
        (m.name.starts_with("COMMAND_") || m.name == "SET_MODE"))
      return m.sent_at;
  }
  for (const auto& logged : record.interactions)
    if (logged.message.uav == uav && logged.message.kind == record::kFinish)
      return same_instant(logged.message.request_at);
  return record.footer ? record.footer->st_at_end : last;
}

void add_setpoints(const record::Record& record, const std::string& uav, Pace& pace) {
  std::vector<double> between_s;
  std::optional<SimTime> previous;
  for (const auto& logged : record.autopilot) {
    const record::AutopilotMessage& m = logged.message;
    if (m.uav != uav || !m.is_setpoint()) continue;
    if (previous) between_s.push_back(to_seconds(m.sent_at - *previous));
    previous = m.sent_at;
  }
  if (between_s.empty()) return;
  pace.setpoint_gap_s = std::max(std::ranges::max(between_s),
                                 to_seconds(end_of_setpoints(record, uav, *previous) - *previous));
  const double median_s = quantile(std::move(between_s), 0.5);
  if (median_s > 0.0) pace.setpoint_hz = 1.0 / median_s;
}

Pace::Losses losses_of(const record::Record& record) {
  std::map<std::string, ExecTime> ends;  // of the programs
  for (const auto& logged : record.interactions)
    ends[logged.message.uav] = logged.message.request_at;
  Pace::Losses losses;
  for (const auto& logged : record.commands) {
    const record::CommandEffect& effect = logged.message;
    if (effect.loss.empty() || effect.loss == "keep" ||
        same_instant(effect.applied_at) > ends[effect.uav])
      continue;
    if (losses.count++ == 0)
      losses = {
          .count = 1, .first_at = effect.applied_at, .uav = effect.uav, .action = effect.loss};
  }
  return losses;
}

Pace pace_of(const record::Record& record, const record::SutInfo& sut) {
  Timing timing;
  timing.runs = {run_of(record, sut)};
  add_open_call(record, sut, timing.runs.front());
  Pace pace{.uav = sut.uav, .seed = record.header.seed, .stages = stage_rows(timing)};
  const auto shares = [&](const record::SutInfo& other) {
    return other.board == sut.board && other.pinned_core == sut.pinned_core;
  };
  const auto programs = std::ranges::count_if(record.header.suts, shares);
  // How long a program waited for cores is known of a modelled board only.
  const bool is_real = std::ranges::any_of(record.header.boards, [&](const auto& board) {
    return board.name == sut.board && board.is_real;
  });
  pace.shares_real_board = is_real;
  if (!sut.board.empty() && !is_real && programs > 1) {
    pace.shared_board = sut.board;
    pace.programs = static_cast<std::size_t>(programs);
  }
  for (const auto& [name, intervals] : intervals_of(record, sut.uav, timing.runs.front())) {
    if (intervals.between_s.empty() || intervals.images <= pace.images) continue;
    pace.camera = name;
    pace.images = intervals.images;
    const double between_s = quantile(intervals.between_s, 0.5);
    pace.read_hz = between_s > 0.0 ? 1.0 / between_s : 0.0;
    pace.median_s = quantile(intervals.costs_s, 0.5);
    pace.p95_s = quantile(intervals.costs_s, 0.95);
    pace.waiting =
        intervals.all_costs_s > 0.0 ? intervals.all_waited_s / intervals.all_costs_s : 0.0;
    pace.offered_hz = intervals.offered_hz;
    const double all_s =
        std::accumulate(intervals.between_s.begin(), intervals.between_s.end(), 0.0);
    pace.behind = all_s > 0.0 ? intervals.behind_s / all_s : 0.0;
    if (record.footer && record.footer->st_at_end > SimTime{})
      pace.reading = std::min(1.0, all_s / to_seconds(record.footer->st_at_end));
  }
  add_setpoints(record, sut.uav, pace);
  return pace;
}

constexpr std::string_view kLoader = "library ld-";

/// Without libraries.
std::string build_of(const record::SutInfo& sut) {
  std::string all = sut.build_id;
  for (const record::BuildPart& part : sut.build)
    if (!part.name.starts_with(kLibraryPart)) all += "\n" + part.name + " " + part.value;
  return all;
}

/// "libx.so 1f2e"
std::vector<std::string> libraries_of(const record::SutInfo& sut) {
  std::vector<std::string> libraries;
  for (const record::BuildPart& part : sut.build)
    if (part.name.starts_with(kLibraryPart))
      libraries.push_back(part.name.substr(kLibraryPart.size()) + " " + part.value);
  std::ranges::sort(libraries);
  return libraries;
}

std::string loader_of(const record::SutInfo& sut) {
  const auto found = std::ranges::find_if(
      sut.build, [](const auto& part) { return part.name.starts_with(kLoader); });
  return found == sut.build.end() ? "" : found->name;
}

Speed speed_of(const record::Header& header) {
  Speed speed{.boards = header.boards, .machine = header.machine, .emulator = header.emulator};
  if (header.target) speed.target = header.target->name + " " + header.target->address;
  for (const record::SutInfo& sut : header.suts)
    speed.programs.push_back({.uav = sut.uav,
                              .clock = sut.clock,
                              .replay = sut.replay,
                              .board = sut.board,
                              .computer = sut.computer,
                              .launcher = sut.launcher,
                              .concurrent = sut.concurrent,
                              .build = build_of(sut),
                              .libraries = libraries_of(sut),
                              .loader = loader_of(sut),
                              .pinned_core = sut.pinned_core,
                              .idle_W = sut.energy ? sut.energy->idle_W : 0.0,
                              .busy_core_W = sut.energy ? sut.energy->busy_core_W : 0.0});
  return speed;
}

}  // namespace

std::string Pace::Losses::text() const {
  return fmt::format(
      "had no new set-point for too long {} ST {:.3f} s, and its flight controller did what "
      "on_setpoint_loss = \"{}\" says",
      count == 1 ? "once, at" : fmt::format("{} times, first at", count), to_seconds(first_at),
      action);
}

bool Speed::is_scripted() const {
  return !programs.empty() && std::ranges::all_of(programs, [](const Program& program) {
    return program.clock.kind == computer::ClockKind::kScripted;
  });
}

bool Speed::is_instant() const {
  return is_scripted() && std::ranges::all_of(programs, [](const Program& program) {
           return program.clock.computing <= kNoTime;
         });
}

bool Speed::measures_waits() const {
  return std::ranges::any_of(programs,
                             [](const Program& program) { return program.clock.counts_waiting(); });
}

bool Speed::stretches_unseen_waits() const {
  return std::ranges::any_of(programs, [](const Program& program) {
    return program.concurrent && program.clock.counts_waiting() && program.clock.is_scaled();
  });
}

std::optional<double> Pace::headroom() const {
  if (!offered_hz || !(p95_s > 0.0)) return std::nullopt;
  return 1.0 / (*offered_hz * p95_s);
}

bool Pace::reads_nearly_every() const {
  return offered_hz && read_hz >= kNearlyEvery * *offered_hz;
}

bool Pace::keeps_up() const {
  return reads_nearly_every() && behind < kHardlyEver && unqueued.empty();
}

bool Pace::is_too_slow_for_camera() const {
  const std::optional<double> room = headroom();
  return room && *room < 1.0 && !keeps_up();
}

std::optional<Pace> pace_of(const record::Record& record) {
  if (record.header.policy != record::kConservativeBarrier) return std::nullopt;
  std::vector<Pace> paces;
  for (const record::SutInfo& sut : record.header.suts) paces.push_back(pace_of(record, sut));
  const Pace* slowest = nullptr;
  for (const Pace& pace : paces)
    if (!pace.stages.empty() && (!slowest || pace.p95_s > slowest->p95_s)) slowest = &pace;
  if (!slowest) return std::nullopt;
  Pace found = *slowest;
  found.boards = board_paces(record, paces);
  found.losses = losses_of(record);
  found.speed = speed_of(record.header);
  found.radio = to_text(record.header.radio);
  found.messages = record.radio.size();
  found.messages_arrived = static_cast<std::size_t>(std::ranges::count(
      record.radio, record::kDelivered,
      [](const auto& logged) { return std::string_view(logged.message.outcome); }));
  return found;
}

}  // namespace tether::timing
