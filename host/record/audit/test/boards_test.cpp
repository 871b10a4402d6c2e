#include "checks.h"

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

// What each SUT of a shared board computed, against its share of the cores.
namespace tether::audit {
namespace {

struct Call {
  std::string uav;
  std::int64_t computed, request_at, reply_at;
  bool is_last = false;
};

record::Record board_record(int cores, const std::vector<Call>& calls,
                            std::optional<int> core_of_c = std::nullopt) {
  record::Record record;
  record.header.boards = {{"obc", cores}};
  for (const char* uav : {"a", "b", "c"}) {
    record::SutInfo& sut = record.header.suts.emplace_back();
    sut.uav = uav;
    sut.board = "obc";
    if (*uav == 'c') record.header.suts.back().pinned_core = core_of_c;
  }
  for (const Call& call : calls) {
    record::Interaction m;
    m.uav = call.uav;
    m.kind = call.is_last ? record::kFinish : record::kSleep;
    m.computed = Duration(call.computed);
    m.request_at = from_ns<ExecTime>(call.request_at);
    m.reply_at = from_ns<ExecTime>(call.reply_at);
    record.interactions.push_back({{}, 0, m});
  }
  return record;
}

std::size_t findings(const record::Record& record) {
  Verdict verdict;
  Report report(verdict);
  check_boards(record, report);
  for (const Finding& finding : verdict.findings) EXPECT_EQ(finding.rule, 5) << finding.what;
  return verdict.findings.size();
}

// c waits from 8 to 20; a and b have a core each from then on.
const std::vector<Call> kSound = {
    {"a", 3, 5, 5},         {"b", 3, 5, 5},          {"c", 5, 8, 20},  // 3 on 2 cores: 2/3 each
    {"a", 4, 10, 10, true}, {"b", 10, 16, 16, true}, {"c", 1, 21, 21, true},
};

TEST(Boards, SoundRecordsHaveNoFindings) {
  EXPECT_EQ(findings(board_record(2, kSound)), 0u);
}

TEST(Boards, ANanosecondTooEarlyOrTooLateIsFound) {
  for (std::size_t i = 0; i < kSound.size(); ++i)
    for (const std::int64_t change : {-1, 1}) {
      record::Record record = board_record(2, kSound);
      *record.interactions[i].message.computed += Duration(change);
      EXPECT_EQ(findings(record), 1u) << i << " " << change;
    }
  EXPECT_GT(findings(board_record(1, kSound)), 0u) << "one core is not enough for that";
  EXPECT_GT(findings(board_record(3, kSound)), 0u);
  EXPECT_GT(findings(board_record(2, kSound, 0)), 0u) << "a pinned core is not shared";
  record::Record unknown = board_record(2, kSound);
  unknown.interactions[0].message.computed.reset();
  EXPECT_EQ(findings(unknown), 1u);
}

TEST(Boards, NamesOfBoardsBelongTogether) {
  const auto rules = [](void (*alter)(record::Record&)) {
    record::Record record = board_record(2, kSound);
    alter(record);
    Verdict verdict;
    Report report(verdict);
    check_boards(record, report);
    return verdict.findings.empty() ? -1 : verdict.findings.front().rule;
  };
  EXPECT_EQ(rules([](record::Record& r) { r.header.boards.clear(); }), 0);
  EXPECT_EQ(rules([](record::Record& r) { r.header.boards.push_back({"spare", 1}); }), 0);
  EXPECT_EQ(rules([](record::Record& r) { r.header.suts[1].board.clear(); }), 5);
}

TEST(Boards, AProgramAloneOnItsCoreNeedsNoComputedTime) {
  record::Record record =
      board_record(2, {{"a", 2, 2, 2, true}, {"b", 2, 4, 4, true}, {"c", 9, 9, 9, true}}, 0);
  record.interactions[0].message.request_at = from_ns<ExecTime>(4);
  record.interactions[2].message.computed.reset();
  EXPECT_EQ(findings(record), 0u);
}

/// Two SUTs on a real board; the ETs at which each stopped.
record::Record stops_record(const std::vector<std::int64_t>& a,
                            const std::vector<std::int64_t>& b) {
  record::Record record;
  record.header.boards = {{"obc", 0, true}};
  for (const auto& [uav, stops] : {std::pair("a", a), std::pair("b", b)}) {
    record.header.suts.push_back({.uav = uav,
                                  .sut = "",
                                  .clock = {computer::ClockKind::kWall},
                                  .concurrent = true,
                                  .board = "obc"});
    for (const std::int64_t at : stops)
      record.stops.push_back({{}, 0, {uav, from_ns<ExecTime>(at), std::nullopt, {}}});
  }
  return record;
}

TEST(Boards, AStopOfOneSutOfARealBoardIsFound) {
  EXPECT_EQ(findings(stops_record({1, 5, 9}, {1, 5, 9})), 0u);
  EXPECT_EQ(findings(stops_record({1, 5, 9}, {1, 5})), 0u) << "b has finished";
  EXPECT_EQ(findings(stops_record({1, 5, 9}, {1, 9})), 1u);
  EXPECT_EQ(findings(stops_record({1, 5, 9}, {1, 6, 9})), 2u);
  record::Record other = stops_record({1, 5, 9}, {1, 9});
  other.header.suts[1].board = "another";
  other.header.boards.push_back({"another", 0, true});
  EXPECT_EQ(findings(other), 0u);
}

TEST(Boards, NothingIsFoundWhereTheWorkOfAnotherIsNotKnown) {
  std::vector<Call> cut = kSound;
  cut.pop_back();  // c computes from 20 on; the others have finished
  EXPECT_EQ(findings(board_record(2, cut)), 0u);
  cut = {{"a", 3, 5, 5}, {"b", 3, 5, 5}, {"a", 999, 9, 9}};
  EXPECT_EQ(findings(board_record(2, cut)), 0u) << "c has computed from 0 on";
}

}  // namespace
}  // namespace tether::audit
