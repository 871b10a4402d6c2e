// The fate of each message between UAVs, worked out again: from the settings of the radio, the
// positions of the UAVs, who transmitted when, and the same draws. When a UAV of several may
// transmit is not worked out, because that depends on all of the channel's past.

#include "checks.h"
#include "tracks.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <tether/base/random.h>

namespace tether::audit {
namespace {

using Fate = record::Logged<record::RadioMessage>;
using record::RadioInfo;
using record::RadioMessage;

constexpr double kRounding_db = 1e-6;

double linear(double db) {
  return std::pow(10.0, db / 10.0);
}
double decibels(double linear) {
  return 10.0 * std::log10(linear);
}

class ChannelCheck {
 public:
  ChannelCheck(const record::Record& record, const Boundaries& grid, Report& report)
      : record_(record),
        radio_(record.header.radio),
        grid_(grid),
        report_(report),
        is_ideal_(radio_.model == "ideal"),
        is_drawn_(radio_.model == "distribution"),
        tracks_(tracks_of(record)) {
    for (const record::SutInfo& sut : record.header.suts)
      indices_.emplace(sut.uav, indices_.size());
    for (const Fate& fate : record.radio)
      if (fate.message.began_at) air_[fate.message.uav][wide(*fate.message.began_at)] = end(fate);
  }

  void run() {
    for (const Fate& fate : record_.radio) {
      const RadioMessage& m = fate.message;
      if (!indices_.contains(m.uav) || !indices_.contains(m.to))
        continue;  // check_radio reports it
      check_copies(fate);
      check_times(fate);
      if (m.outcome == record::kWaiting) continue;
      const bool was_transmitted =
          !is_ideal_ && !is_drawn_ && m.outcome != "queue_full" && m.outcome != "too_long";
      const bool has_all = m.began_at && m.distance_m && m.walls && m.snr_db;
      const bool has_any = m.began_at || m.distance_m || m.walls || m.snr_db;
      if (was_transmitted ? !has_all : has_any)
        report_.add(0, fate, "message {} {} the values of its transmission", m.outcome,
                    was_transmitted ? "without" : "with");
      else if (was_transmitted)
        check_link(fate);
    }
    if (is_drawn_) check_drops();
    check_queues();
    check_inboxes();
  }

 private:
  double bits(std::uint64_t bytes) const {
    return 8.0 * static_cast<double>(bytes + radio_.header_bytes);
  }
  Wide air_time(std::uint64_t bytes) const {
    constexpr double kMost = 1e30;  // whatever the record contains
    const double data_ns = std::ceil(bits(bytes) / radio_.data_rate_bit_s * 1e9);
    return wide(radio_.preamble) + static_cast<Wide>(std::min(data_ns, kMost));
  }
  // Of a radio without a channel.
  Wide drawn_air_time(std::uint64_t bytes) const {
    if (!(radio_.data_rate_bit_s > 0.0)) return 0;
    constexpr double kMost = 1e30;
    return static_cast<Wide>(std::min(
        std::ceil(8.0 * static_cast<double>(bytes) / radio_.data_rate_bit_s * 1e9), kMost));
  }
  Wide end(const Fate& fate) const {
    return wide(*fate.message.began_at) + air_time(fate.message.bytes);
  }

  // A message to several UAVs is one transmission.
  void check_copies(const Fate& fate) {
    const RadioMessage& m = fate.message;
    const auto [first, is_new] = first_.try_emplace({m.uav, m.sequence}, &fate);
    const RadioMessage& other = first->second->message;
    if (!is_new && std::tie(m.bytes, m.sent_at, m.began_at) !=
                       std::tie(other.bytes, other.sent_at, other.began_at))
      report_.add(0, fate, "message to \"{}\" differs from that to \"{}\"", m.to, other.to);
  }

  void check_times(const Fate& fate) {
    const RadioMessage& m = fate.message;
    const Wide at = wide(m.at), sent = wide(m.sent_at);
    if (m.outcome == record::kWaiting) {
      if (record_.footer && fate.at != record_.footer->st_at_end)
        report_.add(0, fate, "message that waits at {}, before the end of the run", ns(fate.at));
    } else if (is_ideal_) {
      if (at != sent + wide(radio_.least_delay))
        report_.add(0, fate, "message sent at {} {} at {}, not after the radio's delay of {}",
                    ns(sent), m.outcome, ns(at), ns(radio_.least_delay));
    } else if (is_drawn_) {
      const Wide delay = at - sent - drawn_air_time(m.bytes);
      if (delay < wide(radio_.least_delay) || delay > wide(radio_.most_delay))
        report_.add(0, fate, "message sent at {} {} at {}, with a delay of {} instead of {} to {}",
                    ns(sent), m.outcome, ns(at), ns(delay), ns(radio_.least_delay),
                    ns(radio_.most_delay));
    } else if (m.began_at) {
      if (at != end(fate) || wide(*m.began_at) < sent + wide(radio_.delay))
        report_.add(0, fate, "message sent at {}, transmitted from {} for {}, was {} at {}",
                    ns(sent), ns(*m.began_at), ns(air_time(m.bytes)), m.outcome, ns(at));
    }
    if (radio_.access == "tdma" && m.began_at && radio_.slot > Duration(0)) check_slot(fate);
    const bool is_long = radio_.access == "tdma" && air_time(m.bytes) > wide(radio_.slot);
    if (is_long != (m.outcome == "too_long") && m.outcome != "queue_full" &&
        m.outcome != record::kWaiting)
      report_.add(0, fate, "message of {} bytes was {}", m.bytes, m.outcome);
  }

  void check_slot(const Fate& fate) {
    const Wide slot = wide(radio_.slot), slots = static_cast<Wide>(indices_.size());
    const Wide began = wide(*fate.message.began_at);
    if (began / slot % slots != static_cast<Wide>(indices_.at(fate.message.uav)) ||
        began % slot + air_time(fate.message.bytes) > slot)
      report_.add(0, fate, "message transmitted at {}, not in a slot of its sender", ns(began));
  }

  // --- what is drawn
  // ------------------------------------------------------------------------------

  // Rule 0: from one UAV to another, each message begins, goes on with or ends a burst of losses,
  // in the order of sending.
  void check_drops() {
    std::map<std::tuple<std::string, std::string, std::uint64_t>, const Fate*> messages;
    for (const Fate& fate : record_.radio)
      messages.emplace(std::tuple(fate.message.uav, fate.message.to, fate.message.sequence), &fate);
    std::map<std::pair<std::string, std::string>, bool> bursts;
    for (const auto& [key, fate] : messages) {
      const RadioMessage& m = fate->message;
      bool& is_burst = bursts[{m.uav, m.to}];
      const double change =
          is_burst ? radio_.burst_end_probability : radio_.burst_begin_probability;
      if (uniform(m, "radio burst") < change) is_burst = !is_burst;
      const bool is_dropped = is_burst || uniform(m, "radio loss") < radio_.loss_probability;
      const bool has_arrived = m.outcome == record::kDelivered || m.outcome == "inbox_full";
      if (m.outcome != record::kWaiting && (is_dropped ? m.outcome != "dropped" : !has_arrived))
        report_.add(0, *fate, "message was {}, but {} follows from the radio's settings", m.outcome,
                    is_dropped ? "dropped" : record::kDelivered);
    }
  }

  double uniform(const RadioMessage& m, const char* quantity) const {
    return KeyedRandom({.seed = record_.header.seed,
                        .stream = random_stream(m.uav, m.to, quantity),
                        .index = m.sequence})
        .uniform();
  }

  // --- what is received
  // ---------------------------------------------------------------------------

  void check_link(const Fate& fate) {
    const RadioMessage& m = fate.message;
    if (const auto [near, far] = distances_m(m.uav, m.to, fate.at);
        !(*m.distance_m >= near && *m.distance_m <= far))
      report_.add(0, fate, "message over {:.6g} m, but the UAVs were {:.6g} to {:.6g} m apart",
                  *m.distance_m, near, far);
    const double signal_dbm = power_dbm(m.uav, m.to, *m.distance_m, *m.walls);
    const double noise_dbm = -174.0 + decibels(radio_.bandwidth_hz) + radio_.noise_figure_db;
    double most = linear(noise_dbm);
    bool transmitted = false, disturbed = false;
    for (const std::string& other : transmitting(fate)) {
      transmitted |= other == m.to;
      disturbed |= other != m.to;
      // How many walls are between these two is not known.
      if (other != m.to)
        most += linear(power_dbm(other, m.to, distances_m(other, m.to, fate.at).first, 0));
    }
    const double best_db = signal_dbm - noise_dbm;
    const double worst_db = disturbed ? signal_dbm - decibels(most) : best_db;
    if (!(*m.snr_db <= best_db + kRounding_db && *m.snr_db >= worst_db - kRounding_db))
      report_.add(0, fate,
                  "message with {:.6f} dB, but {:.6f} to {:.6f} dB follow from the radio's "
                  "settings",
                  *m.snr_db, worst_db, best_db);
    check_outcome(fate, best_db, transmitted);
  }

  // One draw decides, with the noise and with the interference.
  void check_outcome(const Fate& fate, double best_db, bool transmitted) {
    const RadioMessage& m = fate.message;
    const double draw = uniform(m, "radio loss");
    const double by_noise = loss(best_db, m.bytes), by_all = loss(*m.snr_db, m.bytes);
    const auto is_close = [&](double p) { return std::abs(p - draw) < 1e-9; };
    if (is_close(by_noise) || is_close(by_all)) return;
    const std::string_view expected = transmitted       ? "half_duplex"
                                      : draw < by_noise ? "noise"
                                      : draw < by_all   ? "collision"
                                                        : record::kDelivered;
    const bool may_overflow = expected == record::kDelivered && m.outcome == "inbox_full";
    if (m.outcome != expected && !may_overflow)
      report_.add(0, fate, "message at {:.3f} dB was {}, but {} follows from the radio's settings",
                  *m.snr_db, m.outcome, expected);
  }

  double loss(double snr_db, std::uint64_t bytes) const {
    const double eb_n0 = linear(snr_db) * radio_.bandwidth_hz / radio_.data_rate_bit_s;
    return -std::expm1(bits(bytes) * std::log1p(-0.5 * std::erfc(std::sqrt(eb_n0))));
  }

  double power_dbm(const std::string& from, const std::string& to, double distance_m,
                   std::uint64_t walls) const {
    const bool is_first = indices_.at(from) < indices_.at(to);
    KeyedRandom random(
        {.seed = record_.header.seed,
         .stream = random_stream(is_first ? from : to, is_first ? to : from, "radio shadowing")});
    const double shadowing_db =
        radio_.shadowing_db > 0.0 ? radio_.shadowing_db * random.normal() : 0.0;
    return radio_.tx_power_dbm - radio_.reference_loss_db -
           10.0 * radio_.exponent * std::log10(std::max(distance_m, 1.0)) - shadowing_db -
           static_cast<double>(walls) * radio_.wall_loss_db;
  }

  // Other UAVs on the air during the message's transmission.
  std::vector<std::string> transmitting(const Fate& fate) const {
    std::vector<std::string> others;
    for (const auto& [uav, transmissions] : air_) {
      if (uav == fate.message.uav || !indices_.contains(uav)) continue;
      // Those of one UAV follow each other: the last one that began before the end decides.
      const auto later = transmissions.lower_bound(end(fate));
      if (later != transmissions.begin() && std::prev(later)->second > wide(*fate.message.began_at))
        others.push_back(uav);
    }
    return others;
  }

  // From the ground truth before and after: in between, no UAV leaves the straight line by more
  // than its acceleration, or a hit, explains.
  std::pair<double, double> distances_m(const std::string& a, const std::string& b,
                                        SimTime at) const {
    double apart[3] = {}, slack_m = 1e-6;
    for (const auto& [uav, sign] : {std::pair(&a, 1.0), {&b, -1.0}}) {
      const Track& track = tracks_.at(*uav);
      const record::GroundTruth* after = track.at_or_after(at);
      const record::GroundTruth* before = after && after->at == at ? after : track.before(at);
      if (after == nullptr || before == nullptr) return {0.0, HUGE_VAL};
      const double all_s = seconds_between(before->at, after->at);
      const double share = all_s > 0.0 ? seconds_between(before->at, at) / all_s : 0.0;
      for (int i = 0; i < 3; ++i)
        apart[i] += sign * ((1.0 - share) * before->p_WB_m[i] + share * after->p_WB_m[i]);
      const double most_m_s2 = track.acceleration_m_s2(before->at, after->at);
      slack_m +=
          kMargin * all_s * (distance(before->v_WB_m_s, after->v_WB_m_s) + most_m_s2 * all_s) / 4.0;
    }
    const double middle = std::hypot(apart[0], apart[1], apart[2]);
    return {std::max(0.0, middle - slack_m), middle + slack_m};
  }

  // --- queues and inboxes
  // -------------------------------------------------------------------------

  // Rule 0: a message is refused by its sender's queue only if that is full.
  void check_queues() {
    if (is_ideal_ || is_drawn_) return;
    std::map<std::string, std::vector<SimTime>> left;  // by sender: when each left its queue
    for (const auto& [key, fate] : first_) {
      const RadioMessage& m = fate->message;
      std::vector<SimTime>& times = left[m.uav];
      const auto later = [&](auto place) {
        return static_cast<std::uint64_t>(times.end() - place);
      };
      const std::uint64_t least = later(std::ranges::upper_bound(times, m.sent_at));
      const std::uint64_t most = later(std::ranges::lower_bound(times, m.sent_at));
      const bool was_full = m.outcome == "queue_full";
      if (was_full ? most < radio_.queue_messages : least >= radio_.queue_messages)
        report_.add(0, *fate, "message was {} with {} others in its sender's queue of {}",
                    m.outcome, was_full ? most : least, radio_.queue_messages);
      if (!was_full) times.push_back(m.outcome == record::kWaiting ? SimTime::max() : m.at);
    }
  }

  // Rule 0: so is one by its receiver's inbox.
  void check_inboxes() {
    std::map<std::string, std::vector<Wide>> received;  // by receiver: when
    std::map<std::string, SimTime> left;                // nothing comes into its inbox any more
    for (const auto& entry : record_.interactions) {
      // What comes from the flight controller waits elsewhere.
      if (entry.message.received && entry.message.received->from != kAutopilot)
        received[entry.message.uav].push_back(wide(entry.message.reply_at));
      if (entry.message.kind == record::kFinish) left.try_emplace(entry.message.uav, entry.at);
    }
    if (record_.footer)
      for (const std::string& uav : record_.footer->expelled) left[uav] = SimTime{};
    for (auto& [uav, times] : received) std::ranges::sort(times);
    std::map<std::string, std::uint64_t> arrived;
    for (const Fate& fate : record_.radio) {
      const RadioMessage& m = fate.message;
      const bool was_full = m.outcome == "inbox_full";
      if (!was_full && m.outcome != record::kDelivered) continue;
      if (const auto gone = left.find(m.to); gone != left.end() && fate.at >= gone->second)
        continue;
      const auto& times = received[m.to];
      const auto count = [&](auto end) {
        const auto taken = static_cast<std::uint64_t>(end - times.begin());
        return arrived[m.to] - std::min(arrived[m.to], taken);
      };
      const std::uint64_t most =
          count(std::ranges::lower_bound(times, grid_.at_or_before(wide(m.at))));
      const std::uint64_t least =
          count(std::ranges::upper_bound(times, grid_.at_or_after(wide(m.at))));
      if (was_full ? most < radio_.inbox_messages : least >= radio_.inbox_messages)
        report_.add(0, fate, "message was {} with {} in the receiver's inbox of {}", m.outcome,
                    was_full ? most : least, radio_.inbox_messages);
      arrived[m.to] += was_full ? 0U : 1U;
    }
  }

  const record::Record& record_;
  const RadioInfo& radio_;
  const Boundaries& grid_;
  Report& report_;
  bool is_ideal_;
  bool is_drawn_;  // by distributions: there is no channel either
  std::map<std::string, Track> tracks_;
  std::map<std::string, std::size_t> indices_;
  std::map<std::string, std::map<Wide, Wide>> air_;  // by UAV: from when to when it transmitted
  std::map<std::pair<std::string, std::uint64_t>, const Fate*> first_;  // of each message
};

}  // namespace

void check_channel(const record::Record& record, const Boundaries& grid, Report& report) {
  const RadioInfo& radio = record.header.radio;
  const bool is_older = record.header.time_limit <= Duration(0);  // Tether 0.1.0: without settings
  const bool is_known =
      radio.model == "ideal" || radio.model == "distribution" ||
      (radio.data_rate_bit_s > 0.0 && (radio.access == "csma" || radio.access == "tdma"));
  if (radio.inbox_messages > 0 && is_known)
    ChannelCheck(record, grid, report).run();
  else if (!is_older && !record.radio.empty())
    report.add("messages without the settings of their radio");
}

}  // namespace tether::audit
