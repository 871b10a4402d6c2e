#include "answers/compared.h"

#include "answers/sufficient.h"
#include "tables/report_format.h"

#include <algorithm>
#include <limits>
#include <map>

#include <fmt/format.h>

#include <tether/report/size_report.h>

namespace tether::report {
namespace {

/// A condition so many times faster, or that computes for so little of the camera's period, misses
/// the goal for another reason than speed.
constexpr double kMuchFaster = 10.0;
constexpr double kHardlyComputes = 0.25;
constexpr double kClearlyLess = 0.9;

bool have_same_sensors(const Compared& a, const Compared& b) {
  const auto simulator = [](const Compared& one) {
    const auto& versions = one.flights.front()->versions;
    const auto found = versions.find("simulator");
    return found == versions.end() ? "" : found->second;
  };
  return a.flights.front()->profiles == b.flights.front()->profiles && simulator(a) == simulator(b);
}

/// "library ld-linux-aarch64.so.1": a loader whose name says the architecture.
bool is_usual_loader(const std::string& loader) {
  const std::string name = loader.substr(loader.find_last_of("/ ") + 1);
  return name.starts_with("ld-linux") || name.starts_with("ld-musl");
}

}  // namespace

bool is_of_other_architecture(const Speed::Program& one, const Speed::Program& other) {
  return one.loader != other.loader && is_usual_loader(one.loader) && is_usual_loader(other.loader);
}

namespace {

/// Of another architecture, it must be another build.
bool is_same_program(const Speed::Program& one, const Speed::Program& other) {
  return (one.build == other.build && one.libraries == other.libraries) ||
         is_of_other_architecture(one, other);
}

/// A program may choose its instructions, and more, by the emulated CPU.
bool is_same_cpu(const record::EmulatorInfo& one, const record::EmulatorInfo& other) {
  return one.cpu_model.empty() || other.cpu_model.empty() || one.cpu_model == other.cpu_model;
}

/// What starts the programs, the programs, and what their computers draw.
bool have_same_set_up(const Speed& a, const Speed& b) {
  return std::ranges::equal(
      a.programs, b.programs, [](const Speed::Program& one, const Speed::Program& other) {
        return is_same_program(one, other) && one.launcher == other.launcher &&
               one.idle_W == other.idle_W && one.busy_core_W == other.busy_core_W;
      });
}

}  // namespace

std::string difference_of(const Compared& one, const Compared& other) {
  for (const std::string& line : one.verdict->doubtful)
    if (std::ranges::count(other.verdict->doubtful, line) == 0)
      return "something about it is doubtful";
  if (!have_same_sensors(one, other)) return "its sensors or its simulator differ";
  if (one.pace()->radio != other.pace()->radio) return "its radio differs";
  const Speed &a = one.pace()->speed, &b = other.pace()->speed;
  if (!std::ranges::equal(a.programs, b.programs, is_same_program))
    return "its program is another build, or has other libraries, arguments or files";
  if (!have_same_set_up(a, b)) return "something else starts its program, or its power differs";
  if (!is_same_cpu(a.emulator, b.emulator)) return "its emulated CPU is another model";
  if (!std::ranges::equal(a.programs, b.programs, {}, &Speed::Program::cores,
                          &Speed::Program::cores))
    return "the number of its cores differs";
  // What a program does by a clock of the machine depends on how fast simulated time passes.
  if (one.flights.front()->real_time_factor != other.flights.front()->real_time_factor)
    return "its real_time_factor differs";
  return "";
}

bool differ_in_speed_only(const Compared& a, const Compared& b) {
  return a.verdict->uncharged == b.verdict->uncharged && a.pace() && b.pace() &&
         difference_of(a, b).empty();
}

bool has_times_of_another_kind(const Compared& a, const Compared& b) {
  return a.pace()->speed.is_scripted() != b.pace()->speed.is_scripted();
}

std::optional<Costs> costs_of(const Pace& one, const Pace& other) {
  if (!one.camera.empty() && one.camera == other.camera)
    return Costs{"an image costs", one.median_s, other.median_s};
  for (const timing::StageRow& stage : one.stages) {
    const auto same = std::ranges::find(other.stages, stage.stage, &timing::StageRow::stage);
    if (same != other.stages.end())
      return Costs{fmt::format("“{}” takes", stage.stage), stage.median_s, same->median_s};
  }
  return std::nullopt;
}

namespace {

/// How many times slower the clocks of `one` are, if it differs from `other` in these only, on the
/// same machine: the least of its programs. None: not known from the clocks.
std::optional<double> slowdown_of_clocks(const Speed& one, const Speed& other) {
  if (one.machine != other.machine || one.target != other.target || one.boards != other.boards ||
      one.programs.size() != other.programs.size())
    return std::nullopt;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < one.programs.size(); ++i) {
    const computer::Clock &a = one.programs[i].clock, &b = other.programs[i].clock;
    const bool is_scripted = a.kind == computer::ClockKind::kScripted;
    const bool is_scaled =
        a.kind == computer::ClockKind::kCpu || a.kind == computer::ClockKind::kWall;
    if (a.kind != b.kind || (!is_scripted && !is_scaled)) return std::nullopt;
    least = std::min(least, is_scripted ? to_seconds(a.computing) / to_seconds(b.computing)
                                        : a.factor / b.factor);
  }
  return least;
}

}  // namespace

std::optional<double> slowdown_of(const Compared& one, const Compared& other) {
  if (!differ_in_speed_only(other, one) || other.pace()->speed == one.pace()->speed)
    return std::nullopt;
  if (const auto known = slowdown_of_clocks(one.pace()->speed, other.pace()->speed)) return known;
  const auto costs = costs_of(*one.pace(), *other.pace());
  if (!costs || costs->own_s <= kSameCost * costs->other_s) return std::nullopt;
  return costs->own_s / costs->other_s;
}

bool is_faster(const Compared& other, const Compared& missed) {
  return slowdown_of(missed, other) > 1.0;
}

bool is_much_faster(const Compared& other, const Compared& missed) {
  const auto offered_hz = other.pace()->offered_hz;
  return *slowdown_of(missed, other) >= kMuchFaster ||
         (offered_hz && other.pace()->median_s * *offered_hz <= kHardlyComputes);
}

bool is_instant(const Compared& one) {
  return one.pace() && one.pace()->speed.is_instant();
}

bool reaches_more_often(const ConditionVerdict& a, const ConditionVerdict& b,
                        std::size_t comparisons) {
  ConditionVerdict better = a;
  better.distinct += a.failed;  // which could all have missed it
  return better.distinct_reached * b.distinct > b.distinct_reached * better.distinct &&
         chance_of(better, b) * static_cast<double>(comparisons) < kSignificant;
}

std::string met_by(const ConditionVerdict& other, const ConditionVerdict& missed) {
  for (const MissedLimit& one : missed.missed)
    if (std::ranges::find(other.missed, one.limit, &MissedLimit::limit) == other.missed.end())
      return one.limit;
  return "";
}

namespace {

/// How far flights are beyond a limit that all of them miss, in shares of it.
struct Beyond {
  double least = std::numeric_limits<double>::infinity(), most = 0.0;
};
std::map<std::string, Beyond> beyond_limits(const Compared& one) {
  std::map<std::string, Beyond> limits;
  std::map<std::string, std::size_t> flights;
  const auto add = [&](const std::string& name, std::optional<double> margin) {
    if (!margin || *margin >= 0.0) return;
    Beyond& beyond = limits[name];
    beyond = {std::min(beyond.least, -*margin), std::max(beyond.most, -*margin)};
    ++flights[name];
  };
  for (const campaign::TrialResult* flight : one.flights) {
    for (const campaign::MetricValue& metric : flight->metrics)
      add(in_a_sentence(metric.label), margin_of(metric));
    for (const judge::ClauseVerdict& clause : flight->clauses)
      add(fmt::format("“{}”", clause.name), margin_of(clause));
  }
  std::erase_if(limits,
                [&](const auto& limit) { return flights[limit.first] < one.flights.size(); });
  return limits;
}

}  // namespace

std::string nearer_to(const Compared& faster, const Compared& missed) {
  const auto far = beyond_limits(missed);
  for (const auto& [limit, near] : beyond_limits(faster))
    if (const auto same = far.find(limit);
        same != far.end() && near.most < kClearlyLess * same->second.least)
      return limit;
  return "";
}

namespace {

bool costs_no_more(const Pace& image, const Pace& other) {
  if (image.speed.is_scripted()) return true;
  return !image.camera.empty() && image.camera == other.camera &&
         image.median_s <= kSameCost * other.median_s && image.p95_s <= kSameCost * other.p95_s;
}

}  // namespace

bool is_equally_fast_and_reaches(const Compared& other, const Compared& missed,
                                 std::size_t comparisons) {
  return other.pace() && missed.pace() && is_evidence(*other.verdict) &&
         is_sufficient(other.verdict->ruling) && other.pace()->speed == missed.pace()->speed &&
         have_same_sensors(other, missed) && costs_no_more(*missed.pace(), *other.pace()) &&
         reaches_more_often(*other.verdict, *missed.verdict, comparisons);
}

bool is_equally_fast_with_other_sensors(const Compared& other, const Compared& missed) {
  return other.pace()->speed == missed.pace()->speed && !have_same_sensors(other, missed);
}

std::string why_not_compared(const Compared& other, const Compared& missed) {
  if (!other.pace() || !missed.pace()) return "";
  const std::string difference = difference_of(other, missed);
  if (!difference.empty() || !has_times_of_another_kind(other, missed)) return difference;
  return "one of the two has computing times of the scenario, and the other one measured ones";
}

}  // namespace tether::report
