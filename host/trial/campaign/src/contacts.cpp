#include "contacts.h"

#include "metric_outcome.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

namespace tether::campaign {
namespace {

using Logged = record::Logged<record::Contact>;

std::optional<record::Clearance> clearance_of(const record::Record& record,
                                              const std::string& uav) {
  if (!record.footer) return std::nullopt;
  const auto& all = record.footer->clearances;
  const auto own = std::ranges::find(all, uav, &record::Clearance::uav);
  return own == all.end() ? std::nullopt : std::optional(*own);
}

}  // namespace

std::vector<UavContacts> contacts_of(const record::Record& record, double max_speed_m_s) {
  std::vector<UavContacts> all;
  for (const record::SutInfo& sut : record.header.suts) {
    UavContacts own{.uav = sut.uav};
    if (record.header.reports_contacts) own.count = 0;
    for (const auto& [at, order, contact] : record.contacts) {
      if (contact.uav != sut.uav || !own.count) continue;
      ++*own.count;
      own.hard += contact.speed_m_s > max_speed_m_s ? 1U : 0U;
      if (!own.hardest || contact.speed_m_s > own.hardest->speed_m_s) own.hardest = contact;
    }
    own.nearest = clearance_of(record, sut.uav);
    all.push_back(std::move(own));
  }
  return all;
}

std::string why_crashed(const record::Record& record, double max_speed_m_s) {
  const auto first = std::ranges::find_if(record.contacts, [&](const Logged& logged) {
    return logged.message.speed_m_s > max_speed_m_s;
  });
  if (first == record.contacts.end()) return "";
  const record::Contact& contact = first->message;
  return fmt::format("'{}' hit '{}' at ST {:.6g} s with {:.3g} m/s (at most {:.3g} m/s is allowed)",
                     contact.uav, contact.with, to_seconds(contact.at), contact.speed_m_s,
                     max_speed_m_s);
}

MetricOutcome collisions(const scenario::Metric& metric, const record::Record& record) {
  if (!record.header.reports_contacts)
    return missing("the record has no contacts, because its simulator does not report them");
  const auto count = std::ranges::count_if(record.contacts, [&](const Logged& logged) {
    return logged.message.uav == metric.uav && logged.message.speed_m_s > metric.threshold_m_s;
  });
  return {static_cast<double>(count), ""};
}

MetricOutcome min_clearance_m(const scenario::Metric& metric, const record::Record& record) {
  if (const auto nearest = clearance_of(record, metric.uav)) return {nearest->min_m, ""};
  return missing(fmt::format("the clearance of '{}' was not measured", metric.uav));
}

}  // namespace tether::campaign
