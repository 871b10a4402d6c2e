#include "plots/radio_lanes.h"

#include "plots/inks.h"
#include "plots/shapes.h"
#include "plots/svg.h"
#include "tables/radio_table.h"
#include "tables/report_format.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <tether/stats/sample_statistics.h>

namespace tether::report {
namespace {

constexpr double kRadioWidth = 960.0, kRadioLeft = 190.0, kRadioRight = 750.0, kRadioTop = 34.0,
                 kLinkLane = 36.0, kColumn = 4.0;
constexpr std::size_t kColumns = 140;  // of kColumn
constexpr std::size_t kMostLinks = 24;
const Ink kArrivedInk = series_ink(0);
const Ink kLostInk = series_ink(1);

using Ends = std::pair<std::string, std::string>;  // sender and receiver
struct Batch {
  int arrived = 0, lost = 0;
};
using Batches = std::array<Batch, kColumns>;

/// In their order; of too many, those that lost most, and then those with most messages.
std::vector<Ends> drawn_links(const RadioLinks& links) {
  std::vector<Ends> drawn;
  for (const auto& [ends, link] : links) drawn.push_back(ends);
  if (drawn.size() <= kMostLinks) return drawn;
  const auto rank = [&](const Ends& ends) {
    const RadioLink& link = links.at(ends);
    std::size_t lost = 0;
    for (const auto& [cause, count] : link.lost) lost += count;
    return std::pair(lost, link.messages);
  };
  std::ranges::stable_sort(drawn, std::ranges::greater{}, rank);
  drawn.resize(kMostLinks);
  std::ranges::sort(drawn);
  return drawn;
}

std::map<Ends, Batches> batches_of(const record::Record& record, double end_s) {
  std::map<Ends, Batches> columns;
  for (const auto& [at, order, message] : record.radio) {
    const double place = to_seconds(message.sent_at) / end_s * static_cast<double>(kColumns);
    const auto index = std::min(static_cast<std::size_t>(std::max(place, 0.0)), kColumns - 1);
    Batch& column = columns[{message.uav, message.to}][index];
    if (message.outcome == record::kDelivered)
      ++column.arrived;
    else if (message.outcome != record::kWaiting)
      ++column.lost;
  }
  return columns;
}

/// Half a lane for `most` messages; one message is visible.
std::string draw_columns(const Batches& columns, double middle, int most) {
  std::string svg;
  const auto height = [most](int count) {
    return std::max(2.0, (kLinkLane / 2.0 - 3.0) * count / most);
  };
  for (std::size_t i = 0; i < kColumns; ++i) {
    const double x = kRadioLeft + kColumn * static_cast<double>(i);
    const auto [arrived, lost] = columns[i];
    if (arrived > 0)
      svg +=
          rectangle_svg(x, middle - height(arrived), kColumn - 1.0, height(arrived), kArrivedInk);
    if (lost > 0) svg += rectangle_svg(x, middle, kColumn - 1.0, height(lost), kLostInk);
  }
  return svg;
}

std::string link_summary(const RadioLink& link) {
  const auto ratio = link.delivery_ratio();
  std::string text = ratio ? fmt::format("{:.1f} % of {}", 100.0 * *ratio, link.messages)
                           : fmt::format("{} in transit", link.messages);
  if (!link.delays_s.empty()) text += ", " + short_ms(stats::quantile(link.delays_s, 0.5));
  return text;
}

}  // namespace

std::string radio_lanes(const record::Record& record) {
  const RadioLinks links = radio_links(record);
  const double end_s =
      to_seconds(record.footer ? record.footer->st_at_end : record::last_time(record));
  if (links.empty() || end_s <= 0.0) return "";
  const std::map<Ends, Batches> columns = batches_of(record, end_s);
  int most = 1;
  for (const auto& [ends, row] : columns)
    for (const Batch& column : row) most = std::max({most, column.arrived, column.lost});

  std::string body = rectangle_svg(kRadioLeft, 6.0, 12.0, 12.0, kArrivedInk) +
                     text_svg(kRadioLeft + 16.0, 16.0, "arrived") +
                     rectangle_svg(kRadioLeft + 90.0, 6.0, 12.0, 12.0, kLostInk) +
                     text_svg(kRadioLeft + 106.0, 16.0, "lost");
  const std::vector<Ends> drawn = drawn_links(links);
  if (drawn.size() < links.size())
    body += text_svg(kRadioRight, 16.0,
                     fmt::format("the {} of {} links that lost most", drawn.size(), links.size()),
                     "end");
  double middle = kRadioTop + kLinkLane / 2.0;
  for (const Ends& ends : drawn) {
    body += text_svg(kRadioLeft - 8.0, middle + 4.0, ends.first + " → " + ends.second, "end");
    body += rectangle_svg(kRadioLeft, middle - 0.25, kRadioRight - kRadioLeft, 0.5, Ink::kMuted);
    body += draw_columns(columns.at(ends), middle, most);
    body += text_svg(kRadioRight + 8.0, middle + 4.0, link_summary(links.at(ends)));
    middle += kLinkLane;
  }
  const double bottom = middle - kLinkLane / 2.0;
  body += time_axis_svg(kRadioLeft, kRadioRight, kRadioTop, bottom, end_s);
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" viewBox=\"0 0 {:.0f} {:.0f}\" "
      "aria-label=\"Messages between UAVs over simulated time\">\n{}</svg>\n",
      kRadioWidth, bottom + 42.0, body);
}

}  // namespace tether::report
