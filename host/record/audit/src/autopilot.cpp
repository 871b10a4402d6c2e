// Each direction of each line is computed again from the instants of sending. The messages of one
// direction are in the record in the order in which they were taken, which is that of sending;
// those that were lost are at the instant of sending.

#include "checks.h"
#include "suts.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace tether::audit {
namespace {

using LineEntry = record::Logged<record::AutopilotMessage>;
using record::AutopilotMessage;

// 10 bits for each byte, a buffer of a second, and so much in a second of any line.
constexpr double kBitsOfLineByte = 10.0;
constexpr Wide kLineBuffer = 1'000'000'000, kSecond = 1'000'000'000;
constexpr std::uint64_t kMostInASecond = 10'000, kMostBytesInASecond = std::uint64_t{64} << 20;

const std::set<std::string> kLineOutcomes = {"delivered", "queue_full", "inbox_full", "waiting"};

class AutopilotCheck {
 public:
  AutopilotCheck(const record::Record& record, const SutRow& row,
                 const record::ControllerInfo& controller, Report& report)
      : record_(record), row_(row), controller_(controller), report_(report) {
    for (const auto* entry : row.interactions)
      if (entry->message.kind == record::kSend)
        sends_[entry->message.sequence] = entry->message.request_at;
  }

  void run() {
    for (const bool to_controller : {true, false}) {
      std::vector<const LineEntry*> line;
      for (const LineEntry* entry : row_.autopilot)
        if (!entry->message.of_station && entry->message.to_controller == to_controller)
          line.push_back(entry);
      std::ranges::stable_sort(line, {}, [](const LineEntry* entry) {
        return std::pair(entry->message.sequence, entry->message.part);
      });
      check_line(line);
    }
    for (const LineEntry* entry : row_.autopilot)
      if (entry->message.of_station) check_station(*entry);
  }

 private:
  void check_line(const std::vector<const LineEntry*>& line) {
    LineState state;
    const AutopilotMessage* before = nullptr;
    std::uint64_t next = 1;
    for (const LineEntry* entry : line) {
      const AutopilotMessage& m = entry->message;
      if (!kLineOutcomes.contains(m.outcome) && !(m.to_controller && m.is_refused()))
        report_.add(0, *entry, "unknown outcome \"{}\" of a message", m.outcome);
      check_sent(*entry);
      if (before != nullptr && before->sequence == m.sequence) {
        check_same(*entry, *before);
      } else {
        if (m.part != 0) report_.add(0, *entry, "part {} of a message without the first", m.part);
        if (!m.to_controller && m.sequence != next)
          report_.add(3, *entry, "message {} of the flight controller after message {}", m.sequence,
                      next - 1);
        next = m.sequence + 1;
        if (before != nullptr && m.sent_at < before->sent_at)
          report_.add(3, *entry, "message sent at {} after one that was sent at {}", ns(m.sent_at),
                      ns(before->sent_at));
        check_arrival(*entry, state);
      }
      check_taken(*entry);
      before = &m;
    }
  }

  // What a ground station sends is outside of time: a step takes it, and nothing is before.
  void check_station(const LineEntry& entry) {
    const AutopilotMessage& m = entry.message;
    if (m.to_controller || m.outcome != record::kDelivered || m.acted_at != m.at ||
        m.sent_at != m.at)
      report_.add(0, entry, "message of a ground station that no step took");
    else if (wide(m.at) % wide(controller_.period) != 0)
      report_.add(2, entry, "message of a ground station taken at {}, between steps", ns(m.at));
  }

  void check_same(const LineEntry& entry, const AutopilotMessage& before) {
    const AutopilotMessage& m = entry.message;
    if (m.part != before.part + 1 || m.sent_at != before.sent_at || m.at != before.at ||
        m.outcome != before.outcome || m.acted_at != before.acted_at || m.bytes != before.bytes)
      report_.add(0, entry, "part {} of a message differs from the part before", m.part);
  }

  // By a call of the SUT, or at a step of the controller.
  void check_sent(const LineEntry& entry) {
    const AutopilotMessage& m = entry.message;
    if (!m.to_controller) {
      if ((wide(m.sent_at) - 1) % wide(controller_.period) != 0)
        report_.add(2, entry, "the flight controller sent at {}, between its steps", ns(m.sent_at));
      return;
    }
    const auto sent = sends_.find(m.sequence);
    if (sent == sends_.end()) {
      if (record_.footer && record_.footer->end == "finished")
        report_.add(0, entry, "message that no call sent");
    } else if (wide(sent->second) != wide(m.sent_at)) {
      report_.add(1, entry, "message sent at {} by a call at ET {}", ns(m.sent_at),
                  ns(sent->second));
    }
  }

  struct LineState {
    Wide free_at = 0, second = 0;
    std::uint64_t in_second = 0, bytes_in_second = 0;
  };

  void check_arrival(const LineEntry& entry, LineState& line) {
    const AutopilotMessage& m = entry.message;
    const bool is_full = m.outcome == record::kQueueFull;
    Wide due = wide(m.sent_at);
    if (std::exchange(line.second, due / kSecond) != line.second)
      line.in_second = line.bytes_in_second = 0;
    line.bytes_in_second += m.bytes;
    if (++line.in_second > kMostInASecond || line.bytes_in_second > kMostBytesInASecond) {
      if (!is_full)
        report_.add(3, entry, "message sent at {} was taken, but is number {} of that second",
                    ns(m.sent_at), line.in_second);
    } else if (controller_.link_baud > 0.0) {
      const Wide begins = std::max(due, line.free_at);
      if (is_full != (begins - due > kLineBuffer))
        report_.add(3, entry, "message sent at {} was {}, but the line was busy for {}",
                    ns(m.sent_at), is_full ? "lost" : "taken", ns(begins - due));
      if (!is_full) {
        line.free_at =
            begins + static_cast<Wide>(std::ceil(static_cast<double>(m.bytes) * kBitsOfLineByte *
                                                 1e9 / controller_.link_baud));
        due = line.free_at;
      }
    } else if (is_full) {
      report_.add(3, entry, "message was lost on a line whose bytes take no time");
    }
    if (is_full) return;
    due += wide(controller_.link_latency);
    if (wide(m.at) != due)
      report_.add(wide(m.at) < due ? 1 : 3, entry, "message arrived at {} instead of {}", ns(m.at),
                  ns(due));
  }

  void check_taken(const LineEntry& entry) {
    const AutopilotMessage& m = entry.message;
    const bool is_taken = m.to_controller && m.outcome == record::kDelivered;
    if (is_taken != m.acted_at.has_value())
      return report_.add(0, entry, "a message that is {} was {} by the flight controller",
                         m.outcome, m.acted_at ? "taken" : "not taken");
    if (!is_taken) return;
    const Wide due = Boundaries(controller_.period).at_or_after(wide(m.at));
    // In free running, what is sent at the boundary of a step is sent after it.
    const bool is_after = record_.header.policy == record::kFreeRunning && due == wide(m.at) &&
                          wide(*m.acted_at) == due + wide(controller_.period);
    if (wide(*m.acted_at) != due && !is_after)
      report_.add(2, entry, "the flight controller took at {} what arrived at {}; its step was {}",
                  ns(*m.acted_at), ns(m.at), ns(due));
  }

  const record::Record& record_;
  const SutRow& row_;
  const record::ControllerInfo& controller_;
  Report& report_;
  std::map<std::uint64_t, ExecTime> sends_;
};

}  // namespace

void check_autopilot(const record::Record& record, Report& report) {
  std::set<std::string> with_controllers;
  const auto rows = rows_of(record);
  for (const record::SutInfo& sut : record.header.suts) {
    if (!sut.controller) continue;
    with_controllers.insert(sut.uav);
    if (sut.controller->period <= Duration(0))
      report.add("the period of the flight controller of UAV \"" + sut.uav + "\" is not positive");
    else
      AutopilotCheck(record, rows.at(sut.uav), *sut.controller, report).run();
  }
  for (const LineEntry& entry : record.autopilot)
    if (!with_controllers.contains(entry.message.uav))
      report.add(0, entry, "message of a flight controller, but the UAV has none");
}

}  // namespace tether::audit
