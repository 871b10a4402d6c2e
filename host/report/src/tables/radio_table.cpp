#include "tables/radio_table.h"

#include "tables/report_format.h"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include <tether/stats/sample_statistics.h>

namespace tether::report {
namespace {

std::string causes(const RadioLink& link) {
  std::string text;
  for (const auto& [cause, count] : link.lost)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, cause);
  std::ranges::replace(text, '_', ' ');
  return text.empty() ? "none" : text;
}

}  // namespace

std::optional<double> RadioLink::delivery_ratio() const {
  std::size_t settled = delivered;
  for (const auto& [cause, count] : lost) settled += count;
  if (settled == 0) return std::nullopt;
  return static_cast<double>(delivered) / static_cast<double>(settled);
}

RadioLinks radio_links(const record::Record& record) {
  RadioLinks links;
  for (const auto& logged : record.radio) {
    const record::RadioMessage& message = logged.message;
    RadioLink& link = links[{message.uav, message.to}];
    ++link.messages;
    if (message.distance_m) link.distances_m.push_back(*message.distance_m);
    if (message.outcome == record::kDelivered) {
      ++link.delivered;
      link.delays_s.push_back(to_seconds(message.at - message.sent_at));
    } else if (message.outcome != record::kWaiting) {
      ++link.lost[message.outcome];
    }
  }
  for (auto& [ends, link] : links) std::ranges::sort(link.delays_s);
  return links;
}

Table radio_table(const record::Record& record) {
  Table table;
  table.text_columns = 3;
  table.headings = {
      single_headings({"From", "To", "Lost", "Messages", "Arrived (%)", "Mean delay (ms)",
                       "Longest delay (ms)", "Mean distance (m)"})};
  for (const auto& [ends, link] : radio_links(record)) {
    const auto ratio = link.delivery_ratio();
    const auto& delays = link.delays_s;
    table.rows.push_back(
        {ends.first, ends.second, causes(link), std::to_string(link.messages),
         ratio ? fmt::format("{:.1f}", 100.0 * *ratio) : kNone,
         delays.empty() ? kNone : decimals(1e3 * stats::mean(delays)),
         delays.empty() ? kNone : decimals(1e3 * delays.back()),
         link.distances_m.empty() ? kNone : decimals(stats::mean(link.distances_m))});
  }
  if (!table.rows.empty())
    table.notes = {
        fmt::format("Radio: {}. A message to all UAVs counts once for each. Messages "
                    "in transit at the end are neither arrived nor lost.",
                    record.header.radio.model)};
  return table;
}

}  // namespace tether::report
