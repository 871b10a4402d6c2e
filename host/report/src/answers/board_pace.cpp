#include "answers/board_pace.h"

#include "tables/report_format.h"

#include <algorithm>
#include <functional>
#include <map>

#include <fmt/format.h>

#include <tether/report/verdict.h>

namespace tether::report {
namespace {

constexpr std::size_t kMostBoards = 3;  // that an answer lists

/// Greater for a slower board.
std::pair<double, double> slowness(const BoardPace& board) {
  return {board.p95_s, board.alone.value_or(0.0)};
}

void extend(std::pair<double, double>& range, double value) {
  range = {std::min(range.first, value), std::max(range.second, value)};
}

/// " (50 ms to 70 ms)": the least and the largest of several flights; empty for one.
template <class Text>
std::string spread(const BoardPace& board, const std::pair<double, double>& range,
                   const Text& text) {
  if (board.flights < 2) return "";
  return fmt::format(" ({} to {})", text(range.first), text(range.second));
}

}  // namespace

const BoardPace& slowest_of(std::span<const BoardPace> boards) {
  return *std::ranges::max_element(boards, {}, slowness);
}

std::vector<BoardPace> over_flights(std::span<const std::vector<BoardPace>> flights) {
  std::vector<BoardPace> all;
  for (const std::vector<BoardPace>& flight : flights) {
    if (flight.empty()) continue;
    if (all.empty()) all = std::vector<BoardPace>(flight.size());
    for (std::size_t i = 0; i < std::min(all.size(), flight.size()); ++i) {
      BoardPace& sum = all[i];
      const BoardPace& board = flight[i];
      if (sum.board.empty())
        sum = {.board = board.board,
               .uavs = board.uavs,
               .flights = 0,
               .p95_range_s = {board.p95_s, board.p95_s}};
      ++sum.flights;
      sum.slowest_in += &slowest_of(flight) == &board ? 1U : 0U;
      sum.median_s += board.median_s;
      sum.p95_s += board.p95_s;
      extend(sum.p95_range_s, board.p95_s);
      if (!board.alone) continue;
      if (!sum.alone) sum.alone_range = {*board.alone, *board.alone};
      sum.alone = sum.alone.value_or(0.0) + *board.alone;
      extend(sum.alone_range, *board.alone);
    }
  }
  for (BoardPace& board : all) {
    const auto count = static_cast<double>(board.flights);
    board.median_s /= count;
    board.p95_s /= count;
    if (board.alone) *board.alone /= count;
  }
  return all;
}

std::optional<Answer> slowest_board(const ConditionVerdict& condition) {
  if (!condition.pace || condition.pace->boards.empty()) return std::nullopt;
  std::vector<BoardPace> boards = condition.pace->boards;
  std::ranges::stable_sort(boards, std::greater<>{}, slowness);
  const BoardPace& slowest = boards.front();
  std::vector<std::string> costs, waits;
  for (const BoardPace& board : boards) {
    if (board.p95_s > 0.0 && costs.size() < kMostBoards)
      costs.push_back(fmt::format("{} on “{}” ({}; at most {} in 95 %{})", short_ms(board.median_s),
                                  board.board, joined_with_and(board.uavs), short_ms(board.p95_s),
                                  spread(board, board.p95_range_s, short_ms)));
    if (board.alone && waits.size() < kMostBoards)
      waits.push_back(fmt::format("{}{} for “{}”", share_text(*board.alone),
                                  spread(board, board.alone_range, share_text), board.board));
  }
  if (costs.empty() && waits.empty()) return std::nullopt;
  std::string text = fmt::format(": “{}” of “{}”", slowest.board, condition.condition);
  if (slowest.flights > 1)
    text += fmt::format(", in {} of {} flights", slowest.slowest_in, slowest.flights);
  text += '.';
  if (!costs.empty()) text += fmt::format(" An image costs {}.", joined_with_and(costs));
  if (!waits.empty())
    text +=
        fmt::format(" Of the wall time, the simulation waited {} alone.", joined_with_and(waits));
  if (slowest.flights > 1)
    text += " These are means over the flights, with the least and the largest of a flight.";
  return Answer{"Slowest board", text};
}

}  // namespace tether::report
