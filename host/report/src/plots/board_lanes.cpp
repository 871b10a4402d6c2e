#include "plots/board_lanes.h"

#include "plots/inks.h"
#include "plots/shapes.h"
#include "plots/svg.h"

#include <algorithm>
#include <climits>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include <fmt/format.h>

namespace tether::report {
namespace {

constexpr double kLanesWidth = 960.0, kLanesLeft = 110.0, kLanesRight = 940.0, kCoreHeight = 34.0,
                 kPoolGap = 8.0;
constexpr std::size_t kMostSpans = 2000;

/// SUTs that share cores: those pinned to one core, or those that are not pinned.
struct CorePool {
  std::vector<std::size_t> suts;  // in the header's order
  std::map<ExecTime, std::set<std::size_t>> starts, ends;
};

using CorePools = std::map<int, CorePool>;  // by the pinned core; INT_MAX: not pinned

CorePools pools_of(const record::Record& record, const std::string& board) {
  CorePools pools;
  const auto& suts = record.header.suts;
  for (std::size_t i = 0; i < suts.size(); ++i) {
    if (suts[i].board != board) continue;
    CorePool& pool = pools[suts[i].pinned_core.value_or(INT_MAX)];
    pool.suts.push_back(i);
    ExecTime resumed{};
    for (const auto& [at, order, m] : record.interactions) {
      if (m.uav != suts[i].uav) continue;
      if (m.request_at > resumed) {
        pool.starts[resumed].insert(i);
        pool.ends[m.request_at].insert(i);
      }
      resumed = m.reply_at;
    }
  }
  return pools;
}

std::string lane_part(double x, double y, double width, double height, Ink ink) {
  return fmt::format("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" {}/>\n", x,
                     y, width, height, fill_of(ink));
}

/// Up to where the run is drawn: not more than so many parts.
double drawn_s(const CorePools& pools) {
  std::multiset<ExecTime> ends;
  for (const auto& [core, pool] : pools)
    for (const auto& [at, suts] : pool.ends) ends.insert(at);
  if (ends.empty()) return 0.0;
  return to_seconds(ends.size() <= kMostSpans
                        ? *ends.rbegin()
                        : *std::next(ends.begin(), std::ptrdiff_t{kMostSpans}));
}

/// Each computing SUT has the same height, at most that of a core.
std::string draw_pool(const CorePool& pool, std::size_t cores, double top, double end_s) {
  std::string body;
  std::set<ExecTime> times;
  for (const auto& [at, suts] : pool.starts) times.insert(at);
  for (const auto& [at, suts] : pool.ends) times.insert(at);
  const auto x = [&](ExecTime at) {
    return kLanesLeft + (kLanesRight - kLanesLeft) * std::min(1.0, to_seconds(at) / end_s);
  };
  std::set<std::size_t> computing;
  ExecTime before{};
  for (const ExecTime at : times) {
    const double height = kCoreHeight * static_cast<double>(cores) /
                          static_cast<double>(std::max({cores, computing.size(), std::size_t{1}}));
    double y = top;
    for (const std::size_t sut : computing) {
      body += lane_part(x(before), y, x(at) - x(before), height, series_ink(sut));
      y += height;
    }
    if (const auto ended = pool.ends.find(at); ended != pool.ends.end())
      for (const std::size_t sut : ended->second) computing.erase(sut);
    if (const auto started = pool.starts.find(at); started != pool.starts.end())
      computing.insert(started->second.begin(), started->second.end());
    before = at;
    if (to_seconds(at) >= end_s) break;
  }
  return body;
}

}  // namespace

std::string board_lanes(const record::Record& record, const record::BoardInfo& board) {
  const CorePools pools = pools_of(record, board.name);
  const double end_s = drawn_s(pools);
  if (end_s <= 0.0) return "";
  std::string body;
  double x = kLanesLeft, y = 26.0;
  for (const auto& [core, pool] : pools)
    for (const std::size_t sut : pool.suts) {
      body += lane_part(x, 6.0, 12.0, 12.0, series_ink(sut));
      body += text_svg(x + 16.0, 16.0, record.header.suts[sut].uav);
      x += 100.0;
    }
  const std::size_t pinned = pools.size() - pools.count(INT_MAX);
  for (const auto& [core, pool] : pools) {
    const std::size_t cores =
        core == INT_MAX ? static_cast<std::size_t>(board.cores) - pinned : std::size_t{1};
    body += text_svg(kLanesLeft - 8.0, y + 0.6 * kCoreHeight,
                     core != INT_MAX ? fmt::format("core {}", core)
                     : cores == 1    ? std::string("1 core")
                                     : fmt::format("{} cores", cores),
                     "end");
    body += draw_pool(pool, cores, y, end_s);
    for (std::size_t i = 0; i <= cores; ++i)
      body += lane_part(kLanesLeft, y + kCoreHeight * static_cast<double>(i),
                        kLanesRight - kLanesLeft, 0.5, Ink::kMuted);
    y += kCoreHeight * static_cast<double>(cores) + kPoolGap;
  }
  for (int i = 0; i <= 5; ++i)
    body += text_svg(kLanesLeft + (kLanesRight - kLanesLeft) * i / 5.0, y + 12.0,
                     fmt::format("{:.3g}", end_s * i / 5.0), "middle");
  body += text_svg((kLanesLeft + kLanesRight) / 2.0, y + 28.0, "ST (s)", "middle");
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" viewBox=\"0 0 {:.0f} {:.0f}\" "
      "aria-label=\"{}\">\n{}</svg>\n",
      kLanesWidth, y + 36.0, escape_markup("Cores of " + board.name + " over simulated time"),
      body);
}

}  // namespace tether::report
