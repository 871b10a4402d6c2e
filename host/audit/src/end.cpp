#include "checks.h"

#include <algorithm>
#include <map>
#include <string>

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
  check_st(record, grid, *record.footer, report);
  if (record.footer->et_at_end.size() != record.header.suts.size()) {
    report.add(fmt::format("the record's end has the ET of {} SUTs, but there are {}",
                           record.footer->et_at_end.size(), record.header.suts.size()));
  } else if (report.verdict().synchronised) {
    check_et(record, grid, *record.footer, report);
  }
}

}  // namespace tether::audit
