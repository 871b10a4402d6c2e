#include "altered_record.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <gtest/gtest.h>

// Messages between a flight controller and its SUT: a sound record, and one fault at a time.
namespace tether::audit {
namespace {

using record::AutopilotMessage;
using record::Record;

constexpr std::int64_t kControllerPeriod_ns = 4'000'000, kLatency_ns = 300'000;
constexpr std::uint64_t kBytes = 40;

// Each 1.3 ms the SUT sends; the controller answers each message at the step that takes it, with
// two messages in one, and the SUT receives the answers to the first four.
Record flight(double baud = 0.0) {
  Record record;
  record.header.policy = record::kConservativeBarrier;
  record.header.step = kStep;
  record.header.suts = {{.uav = "a", .sut = "s", .clock = {computer::ClockKind::kScripted}}};
  record.header.suts[0].controller = {.name = "built-in",
                                      .estimate = "truth",
                                      .period = Duration(kControllerPeriod_ns),
                                      .link_baud = baud,
                                      .link_latency = Duration(kLatency_ns)};
  const auto on_line = [&](std::int64_t at, std::int64_t& free_at) {
    if (baud > 0.0)
      at = free_at =
          std::max(at, free_at) +
          static_cast<std::int64_t>(std::ceil(static_cast<double>(kBytes) * 10.0 * 1e9 / baud));
    return from_ns<SimTime>(at + kLatency_ns);
  };
  std::int64_t to_free_at = 0, from_free_at = 0;
  std::uint64_t answers = 0;
  for (std::uint64_t i = 1; i <= 12; ++i) {
    const auto sent_ns = static_cast<std::int64_t>(i) * 1'300'000;
    record.interactions.push_back(call("a", "send", sent_ns, sent_ns, i));
    AutopilotMessage to;
    to.uav = "a";
    to.to_controller = true;
    to.sequence = i;
    to.bytes = kBytes;
    to.sent_at = from_ns<SimTime>(sent_ns);
    to.at = on_line(sent_ns, to_free_at);
    const std::int64_t taken_ns = ceil_ns(to_ns(to.at), kControllerPeriod_ns);
    to.acted_at = from_ns<SimTime>(taken_ns);
    to.outcome = "delivered";
    record.autopilot.push_back({*to.acted_at, 0, to});
    AutopilotMessage from;
    from.uav = "a";
    from.sequence = ++answers;
    from.bytes = kBytes;
    from.sent_at = from_ns<SimTime>(taken_ns + 1);
    from.at = on_line(taken_ns + 1, from_free_at);
    from.outcome = "delivered";
    const SimTime logged = from_ns<SimTime>(floor_ns(to_ns(from.at), kStep.count()));
    record.autopilot.push_back({logged, 0, from});
    from.part = 1;
    record.autopilot.push_back({logged, 0, from});
  }
  auto received = call("a", "receive", 16'000'000, 16'000'000, 13);
  received.message.receive_until = from_ns<ExecTime>(40'000'000);
  received.message.received = {"autopilot", 1, record.autopilot[1].message.at};
  received.message.received_more = 3;
  record.interactions.push_back(received);
  record.interactions.push_back(call("a", "finish", 30'000'000, 30'000'000, 14));
  for (std::size_t i = 0; i < record.interactions.size(); ++i) record.interactions[i].order = i;
  record.footer.emplace();
  record.footer->end = "finished";
  record.footer->st_at_end = from_ns<SimTime>(30'000'000);
  record.footer->et_at_end = {from_ns<ExecTime>(30'000'000)};
  set_figures(record);
  return record;
}

AutopilotMessage& message(Record& record, bool to_controller, std::uint64_t sequence,
                          std::uint64_t part = 0) {
  return std::ranges::find_if(record.autopilot,
                              [&](const auto& entry) {
                                const AutopilotMessage& m = entry.message;
                                return m.to_controller == to_controller && m.sequence == sequence &&
                                       m.part == part;
                              })
      ->message;
}
void erase(Record& record, bool to_controller, std::uint64_t sequence) {
  std::erase_if(record.autopilot, [&](const auto& entry) {
    return entry.message.to_controller == to_controller && entry.message.sequence == sequence;
  });
}

class AutopilotTest : public testing::TestWithParam<Planted> {};

TEST(Autopilot, SoundRecordsHaveNoFindings) {
  for (const double baud : {0.0, 921'600.0, 460'800.0}) {
    const Verdict verdict = audit(flight(baud));
    EXPECT_TRUE(verdict.findings.empty()) << baud << ": " << verdict.findings.front().what;
  }
}

TEST(Autopilot, InFreeRunningAStepMayHavePassed) {
  Record record = flight();
  record.header.policy = record::kFreeRunning;
  AutopilotMessage& m = message(record, true, 12);
  const SimTime boundary = from_ns<SimTime>(16'000'000);
  m.at = boundary;
  m.sent_at = boundary - Duration(kLatency_ns);
  record.interactions[11].message.request_at = same_instant(m.sent_at);
  m.acted_at = boundary + Duration(kControllerPeriod_ns);
  EXPECT_FALSE(rules_of(record).contains(2));
  record.header.policy = record::kConservativeBarrier;
  EXPECT_TRUE(rules_of(record).contains(2));
}

TEST(Autopilot, RefusedMessagesAndThoseOfAGroundStationAreSound) {
  Record record = flight();
  AutopilotMessage& refused = message(record, true, 12);
  refused.outcome = "old_signature";
  refused.acted_at.reset();
  AutopilotMessage of_station;
  of_station.uav = "a";
  of_station.of_station = true;
  of_station.sequence = 1;
  of_station.outcome = "delivered";
  of_station.sent_at = of_station.at = from_ns<SimTime>(2 * kControllerPeriod_ns);
  of_station.acted_at = of_station.at;
  record.autopilot.push_back({of_station.at, 0, of_station});
  EXPECT_TRUE(audit(record).findings.empty());
  record.autopilot.back().message.at += kNs;
  EXPECT_TRUE(rules_of(record).contains(0));
  record.autopilot.back().message.sent_at += kNs;
  *record.autopilot.back().message.acted_at += kNs;
  EXPECT_TRUE(rules_of(record).contains(2));
}

TEST_P(AutopilotTest, IsFound) {
  Record record = flight(921'600.0);
  GetParam().plant(record);
  const Verdict verdict = audit(record);
  std::string texts;
  for (const Finding& finding : verdict.findings)
    texts += std::to_string(finding.rule) + ": " + finding.what + "\n";
  EXPECT_EQ(rules_of(verdict), GetParam().rules) << texts;
}

const Planted kOfAutopilots[] = {
    {"TakenAStepEarly",
     {2},
     [](Record& r) { *message(r, true, 5).acted_at -= Duration(kControllerPeriod_ns); }},
    {"TakenAStepLate",
     {2},
     [](Record& r) { *message(r, true, 5).acted_at += Duration(kControllerPeriod_ns); }},
    {"TakenBetweenSteps", {2}, [](Record& r) { *message(r, true, 5).acted_at -= Duration(1); }},
    {"ArrivedEarly", {1}, [](Record& r) { message(r, true, 5).at -= Duration(1); }},
    {"ArrivedLate", {3}, [](Record& r) { message(r, true, 5).at += Duration(1); }},
    {"ArrivedEarlyAtTheSut",
     {1},
     [](Record& r) {
       message(r, false, 5).at -= Duration(1);
       message(r, false, 5, 1).at -= Duration(1);
     }},
    {"SentBeforeItsCall",
     {1, 3},
     [](Record& r) { message(r, true, 5).sent_at -= Duration(500'000); }},
    {"SentBetweenTheSteps",
     {2},
     [](Record& r) {
       message(r, false, 5).sent_at += Duration(7);
       message(r, false, 5, 1).sent_at += Duration(7);
     }},
    {"OneOfTheControllerIsMissing",
     {3},
     [](Record& r) {
       erase(r, false, 12);
       erase(r, false, 11);
       AutopilotMessage copy = message(r, false, 10);
       copy.sequence = 13;
       copy.sent_at += Duration(4 * kControllerPeriod_ns);
       copy.at = copy.sent_at + Duration(kLatency_ns) +
                 Duration(static_cast<std::int64_t>(std::ceil(kBytes * 10.0 * 1e9 / 921'600.0)));
       r.autopilot.push_back({from_ns<SimTime>(29'000'000), 0, copy});
     }},
    {"OneOfTheSutIsMissing", {0}, [](Record& r) { erase(r, true, 12); }},
    {"OneThatNoCallSent",
     {0, 1},
     [](Record& r) {
       AutopilotMessage copy = message(r, true, 12);
       copy.sequence = 99;
       r.autopilot.push_back({*copy.acted_at, 0, copy});
     }},
    {"APartWithoutTheFirst", {0}, [](Record& r) { message(r, false, 5).part = 2; }},
    {"PartsThatDiffer", {0}, [](Record& r) { message(r, false, 5, 1).bytes += 1; }},
    {"AnUnknownOutcome",
     {0},
     [](Record& r) { message(r, false, 5).outcome = message(r, false, 5, 1).outcome = "eaten"; }},
    {"RefusedBySut",
     {0},
     [](Record& r) {
       message(r, false, 5).outcome = message(r, false, 5, 1).outcome = "not_signed";
     }},
    {"LostOnALineWithRoom", {3, 0}, [](Record& r) { message(r, true, 12).outcome = "queue_full"; }},
    {"LostOnALineWithoutBaud",
     {3, 0},
     [](Record& r) {
       r = flight();
       message(r, true, 12).outcome = "queue_full";
     }},
    {"TakenBeyondWhatALineCarriesInASecond",
     {3},
     [](Record& r) { message(r, true, 12).bytes = std::uint64_t{65} << 20; }},
    {"DeliveredButNotTaken", {0}, [](Record& r) { message(r, true, 12).acted_at.reset(); }},
    {"ReceivedBeforeItArrived",
     {1, 3},
     [](Record& r) {
       record::Interaction& m = r.interactions[12].message;
       m.received->sequence = 12;
       m.received->arrived_at = message(r, false, 12).at;
     }},
    {"ReceivedMoreThanHadArrived",
     {1},
     [](Record& r) { r.interactions[12].message.received_more = 11; }},
    {"OfAUavWithoutAController", {0}, [](Record& r) { r.header.suts[0].controller.reset(); }},
    {"APeriodOfZero", {0}, [](Record& r) { r.header.suts[0].controller->period = Duration(0); }},
};
INSTANTIATE_TEST_SUITE_P(Faults, AutopilotTest, testing::ValuesIn(kOfAutopilots),
                         [](const auto& test) { return std::string(test.param.what); });

}  // namespace
}  // namespace tether::audit
