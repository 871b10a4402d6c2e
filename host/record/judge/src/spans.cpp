#include "spans.h"

#include "times.h"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <tether/base/text.h>

namespace tether::judge {
namespace {

constexpr std::string_view kTopic = "mission";
constexpr const char* kUnfinished = "unfinished";

std::string text_of(const nlohmann::json& note, const char* member) {
  const auto found = note.find(member);
  return found != note.end() && found->is_string() ? printable(found->get<std::string>()) : "";
}

bool is_concurrent(const std::string& uav, const record::Record& record) {
  const auto& suts = record.header.suts;
  const auto own = std::ranges::find(suts, uav, &record::SutInfo::uav);
  return own != suts.end() && own->concurrent;
}

std::string cause_of(const record::Interaction& interaction) {
  if (interaction.kind == record::kSensor) return "waiting for " + interaction.sensor;
  return interaction.kind == record::kSleep ? "sleeping" : "in other calls";
}

Duration overlap(SimTime from, SimTime to, const Span& span) {
  return std::max(Duration(0), std::min(to, span.to) - std::max(from, span.from));
}

}  // namespace

std::vector<TaskSpan> task_spans(const mission::Mission& mission, const std::string& uav,
                                 const record::Record& record) {
  const Times times(record);
  std::vector<TaskSpan> spans;
  for (const auto& logged : record.annotations) {
    if (logged.message.uav != uav || logged.message.topic != kTopic) continue;
    const auto note = nlohmann::json::parse(logged.message.json, nullptr, false);
    if (!note.is_object()) continue;
    const std::string task = text_of(note, "task"), event = text_of(note, "event");
    if (std::ranges::count(mission.tasks, task, &mission::Task::name) == 0) continue;
    const SimTime at = times.noted(logged);
    auto span = std::ranges::find(spans, task, &TaskSpan::task);
    if (event == "start" && span == spans.end())
      span = spans.insert(span, {uav, task, at, at, kUnfinished, ""});
    if (span == spans.end()) continue;
    span->status = event == "end" ? text_of(note, "status") : kUnfinished;
    span->reason = event == "end" ? text_of(note, "reason") : "";
    span->to = at;
  }
  for (TaskSpan& span : spans)
    if (span.status == kUnfinished) span.to = std::max(span.from, end_of(record));
  return spans;
}

Span mission_span(const std::string& uav, const record::Record& record) {
  const Times times(record);
  for (const auto& logged : record.interactions) {
    if (logged.message.kind == record::kFinish && logged.message.uav == uav)
      return {SimTime{}, times.sent(logged.message)};
  }
  return {SimTime{}, end_of(record)};
}

std::string time_taken(const std::string& uav, const Span& span, const record::Record& record) {
  if (is_concurrent(uav, record)) return "";
  const Times times(record);
  std::map<std::string, Duration> taken;
  SimTime had_last_at{};
  for (const auto& logged : record.interactions) {
    const record::Interaction& i = logged.message;
    if (i.uav != uav) continue;
    taken["computing"] += overlap(had_last_at, times.sent(i), span);
    taken[cause_of(i)] += overlap(times.sent(i), times.answered(i), span);
    had_last_at = times.answered(i);
  }
  taken["computing"] += overlap(had_last_at, span.to, span);
  std::vector<std::pair<Duration, std::string>> causes;
  for (const auto& [cause, time] : taken)
    if (time > Duration(0)) causes.emplace_back(time, cause);
  std::ranges::stable_sort(causes, std::greater<>(), &std::pair<Duration, std::string>::first);
  std::string text;
  for (const auto& [time, cause] : causes)
    text += fmt::format("{}{} {:.3g} s", text.empty() ? "" : ", ", cause, to_seconds(time));
  return text;
}

}  // namespace tether::judge
