#include "tables/radio_table.h"

#include "tables/report_format.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <tether/stats/sample_statistics.h>

namespace tether::report {
namespace {

struct Link {
  std::size_t sent = 0, delivered = 0;
  std::map<std::string, std::size_t> lost;  // by cause
  std::vector<double> delays_ms, distances_m;
};

std::string mean(const std::vector<double>& values) {
  return values.empty() ? kNone : fmt::format("{:.3f}", stats::mean(values));
}

std::string causes(const Link& link) {
  std::string text;
  for (const auto& [cause, count] : link.lost)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, cause);
  std::ranges::replace(text, '_', ' ');
  return text.empty() ? "none" : text;
}

}  // namespace

Table radio_table(const record::Record& record) {
  std::map<std::pair<std::string, std::string>, Link> links;
  for (const auto& logged : record.radio) {
    const record::RadioMessage& message = logged.message;
    Link& link = links[{message.uav, message.to}];
    ++link.sent;
    if (message.distance_m) link.distances_m.push_back(*message.distance_m);
    if (message.outcome != record::kDelivered) {
      ++link.lost[message.outcome];
      continue;
    }
    ++link.delivered;
    link.delays_ms.push_back(1e3 * to_seconds(message.at - message.sent_at));
  }
  Table table;
  table.text_columns = 3;
  table.headings = {
      single_headings({"From", "To", "Lost", "Messages", "Arrived (%)", "Mean delay (ms)",
                       "Longest delay (ms)", "Mean distance (m)"})};
  for (const auto& [ends, link] : links) {
    const bool has_delay = !link.delays_ms.empty();
    table.rows.push_back(
        {ends.first, ends.second, causes(link), std::to_string(link.sent),
         fmt::format("{:.1f}",
                     100.0 * static_cast<double>(link.delivered) / static_cast<double>(link.sent)),
         mean(link.delays_ms),
         has_delay ? fmt::format("{:.3f}", *std::ranges::max_element(link.delays_ms)) : kNone,
         mean(link.distances_m)});
  }
  if (!links.empty())
    table.notes = {fmt::format("Radio: {}. A message to all UAVs counts once for each.",
                               record.header.radio.model)};
  return table;
}

}  // namespace tether::report
