#include "checks.h"

#include <algorithm>
#include <map>
#include <string>

namespace tether::audit {
namespace {

using record::Footer;

template <class Figure, class Text>
void compare(const char* what, Figure said, Figure found, Text text, Report& report) {
  if (said != found) {
    report.add("the record's end says " + std::string(what) + " " + text(said) + ", there is " +
               text(found));
  }
}

std::string count(std::uint64_t value) {
  return std::to_string(value);
}
std::string span(Duration value) {
  return ns(wide(value));
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
  compare("stops", footer.stops, std::uint64_t{record.stops.size()}, count, report);
  compare("a largest overshoot of", footer.largest_overshoot, overshoot, span, report);
  compare("interactions", footer.interactions, std::uint64_t{record.interactions.size()}, count,
          report);
  compare("causality violations", footer.causality_violations, violations, count, report);
  compare("a largest lag of", footer.largest_lag, lag, span, report);
  compare("a largest grid error of", footer.largest_grid_error, grid_error, span, report);
}

// Nothing lies behind the end, and the ground truth reaches up to it.
void check_st(const record::Record& record, const Boundaries& grid, const Footer& footer,
              Report& report) {
  const Wide end = wide(footer.st_at_end);
  Wide last = 0;
  const auto see = [&](const auto& messages) {
    for (const auto& entry : messages) {
      last = std::max(last, wide(entry.at));
    }
  };
  see(record.interactions);
  see(record.commands);
  see(record.ground_truth);
  see(record.annotations);
  see(record.stops);
  if (last > end) {
    report.add("the run ended at ST " + ns(end) + ", but a message was logged at " + ns(last));
  }

  const Wide period = wide(record.header.ground_truth_period);
  std::map<std::string, Wide> count_by_uav;
  for (const record::SutInfo& sut : record.header.suts) {
    count_by_uav[sut.uav] = 0;
  }
  for (const auto& entry : record.ground_truth) {
    ++count_by_uav[entry.message.uav];
  }
  for (const auto& [uav, truths] : count_by_uav) {
    if (period > 0 && grid.at_or_after(truths * period) <= end) {
      report.add("the ground truth of \"" + uav + "\" stops before the run's end at ST " + ns(end));
    }
  }
}

struct LastWord {
  Wide reply_at = 0;
  bool finished = false;
};

// ET at the end is not before the last reply (rule 5), is that of the reply to a finish, and bounds
// ST while the SUT is running (rule 4).
void check_et(const record::Record& record, const Boundaries& grid, const Footer& footer,
              Report& report) {
  std::map<std::string, LastWord> last;
  for (const auto& entry : record.interactions) {
    last[entry.message.uav] = {wide(entry.message.reply_at), entry.message.kind == record::kFinish};
  }
  // A concurrent SUT goes on, and ends, with the ET at which it stood still.
  for (const auto& entry : record.stops) {
    LastWord& word = last[entry.message.uav];
    word.reply_at = std::max(word.reply_at, wide(entry.message.at));
  }
  for (std::size_t i = 0; i < footer.et_at_end.size(); ++i) {
    const std::string& uav = record.header.suts[i].uav;
    const LastWord& word = last[uav];
    const Wide et = wide(footer.et_at_end[i]);
    const auto finding = [&](int rule, std::string what) {
      report.add({rule, uav, 0, footer.st_at_end, std::move(what)});
    };
    if (word.finished ? et != word.reply_at : et < word.reply_at) {
      finding(5, "ended with ET " + ns(et) + ", its last reply was at ET " + ns(word.reply_at));
    }
    if (!word.finished && wide(footer.st_at_end) > grid.at_or_before(et)) {
      finding(4, "ST ended at " + ns(wide(footer.st_at_end)) + ", ahead of ET " + ns(et) +
                     " of a running SUT");
    }
  }
}

}  // namespace

void check_end(const record::Record& record, const Boundaries& grid, Report& report) {
  if (!record.footer) {
    report.note("the record has no end" + (record.damage.empty() ? "" : ": " + record.damage));
    return;
  }
  if (!record.damage.empty()) {
    report.add("the record is " + record.damage);
  }
  check_figures(record, *record.footer, report);
  check_st(record, grid, *record.footer, report);
  if (record.footer->et_at_end.size() != record.header.suts.size()) {
    report.add("the record's end has the ET of " + count(record.footer->et_at_end.size()) +
               " SUTs, there are " + count(record.header.suts.size()));
  } else if (report.verdict().synchronised) {
    check_et(record, grid, *record.footer, report);
  }
}

}  // namespace tether::audit
