#include "checks.h"

#include <algorithm>
#include <map>
#include <string>
#include <string_view>
#include <utility>

namespace tether::audit {
namespace {

using record::Footer;

std::string text(std::uint64_t value) {
  return std::to_string(value);
}
std::string text(Duration value) {
  return ns(value);
}

template <class Figure>
void compare(const char* what, Figure recorded, Figure actual, Report& report) {
  if (recorded != actual)
    report.add(
        fmt::format("{} at the record's end: {}, actual: {}", what, text(recorded), text(actual)));
}

void check_figures(const record::Record& record, const Footer& footer, Report& report) {
  std::uint64_t violations = 0;
  Duration lag{0};
  Duration grid_error{0};
  for (const auto& entry : record.interactions) {
    violations += entry.message.violation ? 1U : 0U;
    lag = std::max(lag, entry.message.lag);
    grid_error = std::max(grid_error, entry.message.grid_error);
  }
  Duration overshoot{0};
  for (const auto& entry : record.stops) {
    const record::Stop& stop = entry.message;
    if (stop.reply_at) overshoot = std::max(overshoot, stop.at - *stop.reply_at);
  }
  compare("stops", footer.stops, std::uint64_t{record.stops.size()}, report);
  compare("largest overshoot", footer.largest_overshoot, overshoot, report);
  compare("interactions", footer.interactions, std::uint64_t{record.interactions.size()}, report);
  compare("causality violations", footer.causality_violations, violations, report);
  compare("largest lag", footer.largest_lag, lag, report);
  compare("largest grid error", footer.largest_grid_error, grid_error, report);
}

std::map<std::string, std::uint64_t> count_topics(const record::Record& record) {
  std::map<std::string, std::uint64_t> counts = record.unloaded;
  const auto count = [&](std::string topic, const auto&... parts) {
    ((topic += parts.empty() ? "" : "/" + parts), ...);
    ++counts[topic];
  };
  counts["/interactions"] += record.interactions.size();
  counts["/radio"] += record.radio.size();
  for (const auto& [at, order, m] : record.autopilot)
    count("/autopilot", m.uav, std::string(m.direction()), m.name.empty() ? "unknown" : m.name);
  const auto count_all = [&](const char* prefix, const auto& messages) {
    for (const auto& entry : messages) count(prefix, entry.message.uav);
  };
  count_all("/commands", record.commands);
  count_all("/ground_truth", record.ground_truth);
  count_all("/task", record.annotations);
  count_all("/stops", record.stops);
  count_all("/contacts", record.contacts);
  count_all("/battery", record.batteries);
  for (const auto& image : record.images) count("/images", image.message.uav, image.message.sensor);
  for (const auto& image : record.raw_images)
    count(image.message.pixels.index() == 0 ? "/depth" : "/labels", image.message.uav,
          image.message.sensor);
  return counts;
}

// The recorder counted the messages of each topic. Records of Tether 0.1.0 have no such numbers.
void check_topics(const record::Record& record, const Footer& footer, Report& report) {
  const bool is_older = record.header.time_limit <= Duration(0);
  if (footer.topics.empty() != is_older && !record.unloaded.empty())
    report.add("the record's end has no numbers of messages, or its header no time limit");
  if (footer.topics.empty()) return;
  std::map<std::string, std::uint64_t> found = count_topics(record);
  for (const record::TopicCount& topic : footer.topics) {
    compare(("messages of " + topic.topic).c_str(), topic.messages, found[topic.topic], report);
    found.erase(topic.topic);
  }
  for (const auto& [topic, messages] : found)
    if (messages > 0 && !record.unloaded.contains(topic))  // others may add their own
      compare(("messages of " + topic).c_str(), std::uint64_t{0}, messages, report);
}

// The least clearance of each UAV, and when it was reached first.
void check_clearances(const record::Record& record, const Footer& footer, Report& report) {
  std::map<std::string, std::pair<double, SimTime>> least;
  for (const auto& entry : record.ground_truth) {
    const record::GroundTruth& m = entry.message;
    if (!m.clearance_m) continue;
    const auto [known, is_new] = least.try_emplace(m.uav, *m.clearance_m, m.at);
    if (!is_new && *m.clearance_m < known->second.first) known->second = {*m.clearance_m, m.at};
  }
  for (const record::Clearance& recorded : footer.clearances) {
    const auto found = least.find(recorded.uav);
    if (found == least.end() || found->second != std::pair(recorded.min_m, recorded.at))
      report.add(
          fmt::format("the least clearance of \"{}\" at the record's end, {} m at {}, is not "
                      "that of its ground truth",
                      recorded.uav, recorded.min_m, ns(recorded.at)));
    least.erase(recorded.uav);
  }
  for (const auto& [uav, clearance] : least)
    report.add("the record's end has no clearance of \"" + uav + "\"");
}

// What shows how a run ended.
struct Evidence {
  bool has_finished = true;  // every SUT
  bool is_expelled = false;  // a SUT
  bool is_empty = false;     // a battery
  bool is_at_limit = false;
  SimTime last_release;
};

// A UAV without power falls so long before the run ends.
constexpr Wide kFall = 2'000'000'000;  // ns

Evidence evidence_of(const record::Record& record, const Footer& footer) {
  Evidence seen;
  std::map<std::string, bool> finished, empty;
  for (const auto& entry : record.interactions) {
    finished[entry.message.uav] |= entry.message.kind == record::kFinish;
    seen.last_release = std::max(seen.last_release, entry.message.st_at_release);
  }
  for (const record::SutInfo& sut : record.header.suts) seen.has_finished &= finished[sut.uav];
  for (const auto& entry : record.batteries)
    empty[entry.message.uav] = (entry.message.at > SimTime{} && !(entry.message.current_A > 0.0)) ||
                               wide(entry.message.at) + kFall <= wide(footer.st_at_end);
  for (const auto& [uav, is_empty] : empty) seen.is_empty |= is_empty;
  seen.is_expelled = !footer.expelled.empty();
  const Wide limit = wide(record.header.time_limit);
  seen.is_at_limit = limit <= 0 || wide(footer.st_at_end) >= limit;
  for (const std::string& uav : footer.expelled) seen.is_expelled &= !finished[uav];
  return seen;
}

// Whether a run can have ended so. The others have a reason of their own, which only the text
// names: a SUT that is lost, a signal, …
void check_how(const record::Record& record, const Footer& footer, Report& report) {
  const Evidence seen = evidence_of(record, footer);
  const bool has_limit = record.header.time_limit > Duration(0);
  const bool goes_on = !seen.has_finished && !(has_limit && seen.is_at_limit);
  const std::map<std::string_view, bool> possible = {
      {"finished",
       seen.has_finished && footer.expelled.empty() && seen.last_release == footer.st_at_end},
      {"time_limit", !has_limit || wide(footer.st_at_end) == wide(record.header.time_limit)},
      {"battery_empty", seen.is_empty},
      {"flooded", seen.is_expelled},
      {"simulator_lost", !seen.has_finished},
      {"sut_lost", goes_on},
      {"sut_hung", goes_on},
      {"interrupted", goes_on},
      {"killed", goes_on},
      {"timing_differs", goes_on}};
  const auto found = possible.find(footer.end);
  if (found == possible.end())
    report.add("unknown end \"" + footer.end + "\" of the run");
  else if (!found->second)
    report.add(fmt::format("the run ended as \"{}\" at ST {}, which its messages contradict",
                           footer.end, ns(footer.st_at_end)));
}

// WT is measured from the start of the SUTs.
void check_wall(const record::Record& record, const Footer& footer, Report& report) {
  const WallTime start = record.header.wall_at_start;
  if (start == WallTime{}) return;
  for (const auto& entry : record.interactions)
    if (wide(entry.message.wall_at_release) - wide(start) > wide(footer.wall))
      return report.add(fmt::format("the run took {} of WT, but a reply was sent after {}",
                                    ns(footer.wall),
                                    ns(wide(entry.message.wall_at_release) - wide(start))));
}

// No message is after the end, and the ground truth reaches up to it.
void check_st(const record::Record& record, const Boundaries& grid, const Footer& footer,
              Report& report) {
  const Wide end = wide(footer.st_at_end);
  const SimTime last = record::last_time(record);
  if (last > footer.st_at_end)
    report.add(
        fmt::format("the run ended at ST {}, but a message has log time ST {}", ns(end), ns(last)));

  const Wide period = wide(record.header.ground_truth_period);
  std::map<std::string, Wide> count_by_uav;
  for (const record::SutInfo& sut : record.header.suts) count_by_uav[sut.uav] = 0;
  for (const auto& entry : record.ground_truth) ++count_by_uav[entry.message.uav];
  for (const auto& [uav, truths] : count_by_uav) {
    if (period > 0 && grid.at_or_after(truths * period) <= end)
      report.add(fmt::format("the ground truth of \"{}\" stops before the end of the run at ST {}",
                             uav, ns(end)));
  }
}

struct LastReply {
  ExecTime at{};
  bool finished = false;
};

// ET at the end is not before the last reply (rule 5), equals that of the reply to a finish, and is
// an upper bound of ST while the SUT is running (rule 4).
void check_et(const record::Record& record, const Boundaries& grid, const Footer& footer,
              Report& report) {
  std::map<std::string, LastReply> last;
  for (const auto& entry : record.interactions)
    last[entry.message.uav] = {entry.message.reply_at, entry.message.kind == record::kFinish};
  // A concurrent SUT resumes, and ends, with the ET of its stop.
  for (const auto& entry : record.stops) {
    LastReply& reply = last[entry.message.uav];
    reply.at = std::max(reply.at, entry.message.at);
  }
  for (std::size_t i = 0; i < footer.et_at_end.size(); ++i) {
    const std::string& uav = record.header.suts[i].uav;
    const LastReply& reply = last[uav];
    const ExecTime et = footer.et_at_end[i];
    if (reply.finished ? et != reply.at : et < reply.at)
      report.add(
          {5, uav, 0, footer.st_at_end,
           fmt::format("ended with ET {}, but its last reply was at ET {}", ns(et), ns(reply.at))});
    const bool is_expelled = std::ranges::count(footer.expelled, uav) > 0;
    if ((reply.finished || is_expelled) && std::ranges::count(footer.computing, uav) > 0)
      report.add({5, uav, 0, footer.st_at_end, "computed at the end, but had left the run"});
    if (!reply.finished && !is_expelled && wide(footer.st_at_end) > grid.at_or_before(wide(et)))
      report.add({4, uav, 0, footer.st_at_end,
                  fmt::format("ST ended at {}, ahead of ET {} of a running SUT",
                              ns(footer.st_at_end), ns(et))});
  }
}

}  // namespace

void check_end(const record::Record& record, const Boundaries& grid, Report& report) {
  if (!record.footer) return report.note("the record is " + record::describe_damage(record));
  if (!record.damage.empty()) report.add("the record is " + record.damage);
  check_figures(record, *record.footer, report);
  check_topics(record, *record.footer, report);
  check_clearances(record, *record.footer, report);
  check_how(record, *record.footer, report);
  check_wall(record, *record.footer, report);
  check_st(record, grid, *record.footer, report);
  if (record.footer->et_at_end.size() != record.header.suts.size()) {
    report.add(fmt::format("the record's end has the ET of {} SUTs, but there are {}",
                           record.footer->et_at_end.size(), record.header.suts.size()));
  } else if (report.verdict().synchronised) {
    check_et(record, grid, *record.footer, report);
  }
}

}  // namespace tether::audit
