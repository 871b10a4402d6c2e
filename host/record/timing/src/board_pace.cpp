#include "board_pace.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

namespace tether::timing {
namespace {

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

}  // namespace tether::timing
