#include "checks.h"
#include "suts.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <vector>

namespace tether::audit {
namespace {

using Entry = record::Logged<record::Interaction>;
using Fate = record::Logged<record::RadioMessage>;
using record::RadioMessage;

/// A message that a SUT can receive.
struct Inboxed {
  std::string from;
  std::uint64_t sequence = 0;
  SimTime at;
  std::size_t index = 0;  // of its sender: the order at one instant
};

const std::set<std::string> kOutcomes = {"delivered",   "noise",      "collision",
                                         "half_duplex", "queue_full", "too_long",
                                         "inbox_full",  "waiting",    "dropped"};

class RadioCheck {
 public:
  RadioCheck(const record::Record& record, const Boundaries& grid, Report& report)
      : record_(record), grid_(grid), report_(report) {
    for (const record::SutInfo& sut : record.header.suts)
      indices_.emplace(sut.uav, indices_.size());
    for (const Entry& entry : record.interactions)
      if (entry.message.kind == record::kSend)
        sends_[{entry.message.uav, entry.message.sequence}] = &entry;
  }

  void run() {
    std::set<std::tuple<std::string, std::uint64_t, std::string>> seen;
    for (const Fate& fate : record_.radio) {
      const RadioMessage& m = fate.message;
      if (!indices_.contains(m.uav) || !indices_.contains(m.to) || m.uav == m.to)
        report_.add(0, fate, "message from \"{}\" to \"{}\"", m.uav, m.to);
      if (!kOutcomes.contains(m.outcome))
        report_.add(0, fate, "unknown outcome \"{}\" of a message", m.outcome);
      if (!seen.insert({m.uav, m.sequence, m.to}).second)
        report_.add(0, fate, "two fates of a message at UAV \"{}\"", m.to);
      check_sent(fate);
      check_arrival(fate);
      fated_.insert({m.uav, m.sequence});
    }
    for (const auto& entry : record_.autopilot)
      if (entry.message.to_controller) fated_.insert({entry.message.uav, entry.message.sequence});
    if (!record_.footer) return;
    for (const auto& [key, entry] : sends_)
      if (!fated_.contains(key)) report_.add(0, *entry, "message without a fate");
  }

  void check_receives() {
    for (const auto& [uav, row] : rows_of(record_)) {
      std::deque<Inboxed> inbox;
      for (const auto* entry : row.autopilot)
        if (const auto& m = entry->message;
            m.of_controller() && m.part == 0 && m.outcome == record::kDelivered)
          inbox.push_back({kAutopilot, m.sequence, m.at, indices_[uav]});
      for (const auto& [at, order, m] : record_.radio)
        if (m.to == uav && m.outcome == record::kDelivered)
          inbox.push_back({m.uav, m.sequence, m.at, indices_[m.uav]});
      std::ranges::stable_sort(inbox, {},
                               [](const Inboxed& m) { return std::pair(m.at, m.index); });
      std::vector<const Entry*> receives;
      for (const Entry* entry : row.interactions)
        if (entry->message.kind == record::kReceive) receives.push_back(entry);
      // Of a concurrent SUT, a call whose reply was moved up waits for a stop that knows of it.
      // One that waits beside it can have its reply before, for a later time.
      if (row.info->concurrent)
        std::ranges::stable_sort(receives, {},
                                 [](const Entry* entry) { return entry->message.reply_at; });
      for (const Entry* entry : receives) check_receive(*entry, *row.info, inbox);
    }
  }

 private:
  // The call that sent it; in a record of a lost run, it may be missing at the end.
  void check_sent(const Fate& fate) {
    const RadioMessage& m = fate.message;
    const auto sent = sends_.find({m.uav, m.sequence});
    if (sent == sends_.end()) {
      if (record_.footer && record_.footer->end == "finished")
        report_.add(0, fate, "message that no call sent");
    } else if (wide(sent->second->message.request_at) != wide(m.sent_at)) {
      report_.add(1, fate, "message sent at {} by a call at ET {}", ns(m.sent_at),
                  ns(sent->second->message.request_at));
    }
  }

  // Rule 1: no earlier than it can have arrived.
  void check_arrival(const Fate& fate) {
    const RadioMessage& m = fate.message;
    const record::RadioInfo& radio = record_.header.radio;
    Wide least = wide(m.sent_at);
    if (m.outcome == record::kDelivered) {
      least += wide(radio.least_delay);
      if (radio.data_rate_bit_s > 0.0)
        least += static_cast<Wide>(
            std::floor(8.0 * static_cast<double>(m.bytes) / radio.data_rate_bit_s * 1e9));
    }
    if (wide(m.at) < least)
      report_.add(1, fate, "message sent at {} was {} at {}, before {}", ns(m.sent_at), m.outcome,
                  ns(m.at), ns(least));
    if (wide(fate.at) < grid_.at_or_before(wide(m.at)))
      report_.add(0, fate, "message {} at {}, recorded at ST {}", m.outcome, ns(m.at), ns(fate.at));
    if (m.outcome != record::kDelivered) return;
    if (m.at < last_arrival_)
      report_.add(3, fate, "message arrived at {} after another one at {}", ns(m.at),
                  ns(last_arrival_));
    last_arrival_ = std::max(last_arrival_, m.at);
  }

  void check_receive(const Entry& entry, const record::SutInfo& info, std::deque<Inboxed>& inbox) {
    const record::Interaction& m = entry.message;
    if (!m.receive_until) return report_.add(0, entry, "receive without its end");
    if (!m.received) return check_timeout(entry, inbox);
    const auto found = std::ranges::find_if(inbox, [&](const Inboxed& message) {
      return message.from == m.received->from && message.sequence == m.received->sequence;
    });
    if (found == inbox.end())
      return report_.add(1, entry, "received message {} of \"{}\", which has not arrived",
                         m.received->sequence, m.received->from);
    const SimTime arrived_at = found->at;
    if (found != inbox.begin() && !info.concurrent)
      report_.add(3, entry, "received message {} of \"{}\" before others that arrived earlier",
                  m.received->sequence, m.received->from);
    check_more(entry, inbox, inbox.erase(found));
    const Wide due = std::max(wide(m.request_at), wide(arrived_at));
    if (m.received->arrived_at != arrived_at)
      report_.add(1, entry, "received a message that arrived at {}, at {} in its own entry",
                  ns(m.received->arrived_at), ns(arrived_at));
    if (wide(m.reply_at) != due)
      report_.add(wide(m.reply_at) < due ? 1 : 3, entry,
                  "received at ET {} what arrived at {}; requested at ET {}", ns(m.reply_at),
                  ns(arrived_at), ns(m.request_at));
  }

  // Those that came next, of the flight controller only.
  void check_more(const Entry& entry, std::deque<Inboxed>& inbox,
                  std::deque<Inboxed>::iterator next) {
    const record::Interaction& m = entry.message;
    for (std::uint64_t i = 0; i < m.received_more; ++i) {
      if (m.received->from != kAutopilot || next == inbox.end() || next->from != kAutopilot ||
          wide(next->at) > wide(m.reply_at))
        return report_.add(1, entry, "received {} more messages at ET {}, of which {} had arrived",
                           m.received_more, ns(m.reply_at), i);
      next = inbox.erase(next);
    }
  }

  // Of a message at the very instant of the timeout, the order of UAVs decides.
  void check_timeout(const Entry& entry, const std::deque<Inboxed>& inbox) {
    const record::Interaction& m = entry.message;
    if (m.reply_at != *m.receive_until)
      report_.add(7, entry, "received nothing at ET {} instead of ET {}", ns(m.reply_at),
                  ns(*m.receive_until));
    if (inbox.empty()) return;
    const Inboxed& first = inbox.front();
    const bool later = first.index > indices_[m.uav];
    if (wide(first.at) + (later ? 1 : 0) <= wide(m.reply_at))
      report_.add(3, entry, "received nothing at ET {}, but a message had arrived at {}",
                  ns(m.reply_at), ns(first.at));
  }

  const record::Record& record_;
  const Boundaries& grid_;
  Report& report_;
  std::map<std::string, std::size_t> indices_;
  std::map<std::pair<std::string, std::uint64_t>, const Entry*> sends_;
  std::set<std::pair<std::string, std::uint64_t>> fated_;
  SimTime last_arrival_{};
};

}  // namespace

void check_radio(const record::Record& record, const Boundaries& grid, Report& report) {
  RadioCheck check(record, grid, report);
  check.run();
  if (record.header.policy == record::kConservativeBarrier) check.check_receives();
}

}  // namespace tether::audit
