#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <ostream>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include <tether/audit/audit.h>

/// For the generators of records, and for tests that alter a generated record.
namespace tether::audit {

using Entry = record::Logged<record::Interaction>;
using Rules = std::set<int>;

inline constexpr Duration kStep{1'000'000};
inline constexpr Duration kNs{1};

inline std::int64_t floor_ns(std::int64_t t, std::int64_t step) {
  return t / step * step;
}
inline std::int64_t ceil_ns(std::int64_t t, std::int64_t step) {
  return floor_ns(t + step - 1, step);
}

/// Makes it a reading of that sample.
inline void set_sample(record::Interaction& m, std::int64_t sampled, std::int64_t available,
                       std::int64_t step) {
  m.sampled_at = from_ns<SimTime>(sampled);
  m.sample_state_at = from_ns<SimTime>(floor_ns(sampled, step));
  m.available_at = from_ns<SimTime>(available);
  m.reply_at = std::max(m.request_at, from_ns<ExecTime>(available));
  m.grid_error = *m.sampled_at - *m.sample_state_at;
}

/// Makes the figures of the footer those of the messages.
inline void set_figures(record::Record& record) {
  record::Footer& footer = *record.footer;
  footer.interactions = record.interactions.size();
  footer.stops = record.stops.size();
  footer.largest_lag = footer.largest_grid_error = footer.largest_overshoot = Duration(0);
  for (const Entry& entry : record.interactions) {
    footer.largest_lag = std::max(footer.largest_lag, entry.message.lag);
    footer.largest_grid_error = std::max(footer.largest_grid_error, entry.message.grid_error);
  }
  for (const auto& [at, order, stop] : record.stops) {
    if (stop.reply_at)
      footer.largest_overshoot = std::max(footer.largest_overshoot, stop.at - *stop.reply_at);
  }
}

/// The interaction with that predicate, after `skip` others.
inline Entry& entry_where(record::Record& record,
                          const std::function<bool(const record::Interaction&)>& wanted,
                          int skip = 5) {
  for (Entry& entry : record.interactions) {
    if (wanted(entry.message) && skip-- == 0) return entry;
  }
  throw std::logic_error("the generated record has no such interaction");
}
inline record::Interaction& where(record::Record& record,
                                  const std::function<bool(const record::Interaction&)>& wanted,
                                  int skip = 5) {
  return entry_where(record, wanted, skip).message;
}

inline void set_lag(record::Interaction& m) {
  m.lag = lag(m.request_at, m.st_at_arrival);
}

/// At these times of a SUT that is held from its request to the reply.
inline Entry call(std::string uav, std::string kind, std::int64_t request_ns, std::int64_t reply_ns,
                  std::uint64_t sequence) {
  record::Interaction m;
  m.uav = std::move(uav);
  m.kind = std::move(kind);
  m.sequence = sequence;
  m.request_at = from_ns<ExecTime>(request_ns);
  m.reply_at = from_ns<ExecTime>(reply_ns);
  m.st_at_arrival = from_ns<SimTime>(floor_ns(request_ns, kStep.count()));
  m.st_at_release = from_ns<SimTime>(floor_ns(reply_ns, kStep.count()));
  m.grid_error = same_instant(m.reply_at) - m.st_at_release;
  set_lag(m);
  return {m.st_at_release, 0, m};
}

/// The rules that have findings.
inline Rules rules_of(const Verdict& verdict) {
  Rules rules;
  for (const Finding& finding : verdict.findings) rules.insert(finding.rule);
  return rules;
}
inline Rules rules_of(const record::Record& record) {
  return rules_of(audit(record));
}

/// A violation of rules, put into a record that keeps them all.
struct Planted {
  const char* what;
  Rules rules;  ///< exactly these have findings
  std::function<void(record::Record&)> plant;
};

inline void PrintTo(const Planted& planted, std::ostream* out) {
  *out << planted.what;
}

}  // namespace tether::audit
