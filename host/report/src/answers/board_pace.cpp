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

/// When the program of one UAV computed, by the wall clock.
class WallSpans {
 public:
  WallSpans(const record::Record& record, const record::SutInfo& sut)
      : resumed_(record.header.wall_at_start) {
    if (sut.concurrent)
      add_until_stops(record, sut.uav);
    else
      add_until_calls(record, sut.uav);
  }
  const std::vector<std::pair<WallTime, WallTime>>& spans() const { return spans_; }

 private:
  void add_until_calls(const record::Record& record, const std::string& uav) {
    for (const auto& logged : record.interactions) {
      if (logged.message.uav != uav) continue;
      add(logged.message.wall_at_arrival);
      resumed_ = logged.message.wall_at_release;
    }
  }
  // A concurrent one computes until it is stopped, and resumes with the last reply that is sent
  // meanwhile.
  void add_until_stops(const record::Record& record, const std::string& uav) {
    std::vector<WallTime> releases;
    for (const auto& logged : record.interactions)
      if (logged.message.uav == uav) releases.push_back(logged.message.wall_at_release);
    for (const auto& logged : record.stops) {
      if (logged.message.uav != uav) continue;
      const auto next = std::ranges::upper_bound(releases, logged.message.wall);
      if (next != releases.begin()) resumed_ = std::max(resumed_, *std::prev(next));
      add(logged.message.wall);
      resumed_ = logged.message.wall;
    }
  }
  void add(WallTime until) {
    if (resumed_ > WallTime{} && until > resumed_) spans_.emplace_back(resumed_, until);
  }

  WallTime resumed_;
  std::vector<std::pair<WallTime, WallTime>> spans_;
};

const std::string& computer_of(const record::SutInfo& sut) {
  return sut.computer.empty() ? sut.board : sut.computer;
}

void add_shares_alone(std::vector<BoardPace>& boards, const record::Record& record,
                      const std::map<std::string, std::size_t>& index_of) {
  std::map<WallTime, std::map<std::size_t, int>> changes;  // of computing programs, by board
  for (const record::SutInfo& sut : record.header.suts) {
    const WallSpans wall(record, sut);
    for (const auto& [from, to] : wall.spans()) {
      ++changes[from][index_of.at(computer_of(sut))];
      --changes[to][index_of.at(computer_of(sut))];
    }
  }
  if (changes.empty()) return;
  std::vector<int> computing(boards.size(), 0);
  std::vector<Duration> alone(boards.size(), Duration{0});
  WallTime before = changes.begin()->first;
  for (const auto& [at, by_board] : changes) {
    const auto is_computing = [](int programs) { return programs > 0; };
    if (std::ranges::count_if(computing, is_computing) == 1)
      alone[static_cast<std::size_t>(std::ranges::find_if(computing, is_computing) -
                                     computing.begin())] += at - before;
    for (const auto& [board, change] : by_board) computing[board] += change;
    before = at;
  }
  const double all_s = to_seconds(before - changes.begin()->first);
  for (std::size_t i = 0; i < boards.size(); ++i) boards[i].alone = to_seconds(alone[i]) / all_s;
}

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

std::vector<BoardPace> board_paces(const record::Record& record, std::span<const Pace> paces) {
  std::vector<BoardPace> boards;
  std::map<std::string, std::size_t> index_of;
  for (std::size_t i = 0; i < paces.size(); ++i) {
    const std::string& name = computer_of(record.header.suts[i]);
    if (name.empty()) return {};
    const auto [at, is_new] = index_of.try_emplace(name, boards.size());
    if (is_new) boards.push_back({.board = name});
    BoardPace& board = boards[at->second];
    board.uavs.push_back(paces[i].uav);
    if (paces[i].p95_s <= board.p95_s) continue;
    board.median_s = paces[i].median_s;
    board.p95_s = paces[i].p95_s;
  }
  if (boards.size() < 2) return {};
  add_shares_alone(boards, record, index_of);
  return boards;
}

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
