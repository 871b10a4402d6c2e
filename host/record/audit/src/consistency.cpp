#include "checks.h"
#include "driver_draws.h"
#include "file_order.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>

// Rule 0 for every message, in the order of the file: one `visit` for each kind of message. It also
// checks the numbering of interactions (rule 5), and free-running records (rule 8).
namespace tether::audit {
namespace {

using record::CommandEffect;
using record::GroundTruth;
using record::Interaction;
using record::Logged;

bool is_known_kind(std::string_view kind) {
  return kind == record::kSensor || kind == record::kCommand || kind == record::kSleep ||
         kind == record::kFinish || kind == record::kSend || kind == record::kReceive ||
         kind == record::kBattery;
}

// Largest deviation of the length of a rotation from 1.
constexpr double kRotationTolerance = 1e-6;

// Largest number of open calls of one SUT (DESIGN section 2).
constexpr std::uint64_t kMostOpenCalls = 64;

struct SutSequences {
  bool concurrent = false;
  std::uint64_t last = 0;
  std::set<std::uint64_t> seen;
};

class ConsistencyCheck {
 public:
  ConsistencyCheck(const record::Record& record, const Boundaries& grid, Report& report)
      : record_(record), grid_(grid), report_(report) {
    for (const record::SutInfo& sut : record.header.suts)
      suts_[sut.uav].concurrent = sut.concurrent;
  }

  void run() {
    if (suts_.size() != record_.header.suts.size()) report_.add("two SUTs have the same UAV");
    for (const record::SutInfo& sut : record_.header.suts) check_clock(sut);
    for_each_in_file_order(record_, [&](const auto& entry) { visit(entry); });
    for (const auto& [uav, sut] : suts_) check_missing(uav, sut);
    for (const record::Miscount& miscount : record_.miscounts) check_count(miscount);
  }

 private:
  void check_count(const record::Miscount& miscount) {
    const std::uint64_t missing = miscount.found - miscount.expected;
    report_.add({0, "", 0, miscount.at,
                 miscount.found > miscount.expected
                     ? fmt::format("{} message{} of {} missing before number {}", missing,
                                   missing == 1 ? "" : "s", miscount.topic, miscount.found)
                     : fmt::format("number {} of {} repeated or out of order, expected number {}",
                                   miscount.found, miscount.topic, miscount.expected)});
  }

  // Rule 6: the clock of the SUT is that of its condition.
  void check_clock(const record::SutInfo& sut) {
    if (sut.required_clock && *sut.required_clock != sut.clock)
      report_.add({6,
                   sut.uav,
                   0,
                   {},
                   fmt::format("the SUT's clock is \"{}\", but the condition requires \"{}\"",
                               sut.clock.text(), sut.required_clock->text())});
  }

  void visit(const Logged<Interaction>& entry) {
    const Interaction& message = entry.message;
    check_log_time(entry, message.st_at_release);
    check_wall_times(message, entry);
    check_pace(message, entry);
    if (!is_known_kind(message.kind)) report_.add(0, entry, "unknown kind \"{}\"", message.kind);
    // For synchronised records, check_order checks the order of log times.
    if (record_.header.policy == record::kFreeRunning) {
      check_order(entry);
      check_free_running(entry);
    }
    const auto sut = suts_.find(message.uav);
    if (sut == suts_.end())
      return report_.add(0, entry, "no UAV \"{}\" in the record's header", message.uav);
    check_sequence(entry, sut->second);
    reached_ = std::max(reached_, entry.at);
  }

  // Replies are recorded in the order in which they were sent.
  void check_wall_times(const Interaction& message, const Logged<Interaction>& entry) {
    const WallTime arrival = message.wall_at_arrival, release = message.wall_at_release;
    if (arrival != WallTime{} && release != WallTime{} && release < arrival)
      report_.add(0, entry, "reply sent {} before its request arrived",
                  ns(wide(arrival) - wide(release)));
    if (release == WallTime{}) return;
    if (release < wall_at_last_release_)
      report_.add(0, entry, "reply sent {} before the previous reply in the record",
                  ns(wide(wall_at_last_release_) - wide(release)));
    wall_at_last_release_ = std::max(wall_at_last_release_, release);
  }

  // Rule 8: ST is not ahead of its limit relative to WT.
  void check_pace(const Interaction& message, const Logged<Interaction>& entry) {
    const record::Header& header = record_.header;
    if (!(header.real_time_factor > 0.0) || header.wall_at_start == WallTime{} ||
        message.wall_at_arrival == WallTime{})
      return;
    constexpr double kRounding_s = 1e-3;
    const double wall_s =
        static_cast<double>(wide(message.wall_at_arrival) - wide(header.wall_at_start)) * 1e-9;
    const double st_s = static_cast<double>(wide(message.st_at_arrival)) * 1e-9;
    if (st_s > header.real_time_factor * wall_s * (1.0 + kRounding_s) + kRounding_s)
      report_.add(8, entry, "arrived at ST {} after {:.6f} s, faster than {} of real time",
                  ns(message.st_at_arrival), wall_s, header.real_time_factor);
  }

  template <class Message>
  void check_log_time(const Logged<Message>& entry, SimTime at) {
    if (entry.at != at)
      report_.add(0, entry, "log time is ST {}, the message's time is ST {}", ns(entry.at), ns(at));
  }
  template <class Message>
  void check_order(const Logged<Message>& entry) {
    if (entry.at < reached_)
      report_.add(0, entry, "log time ST {} follows ST {}", ns(entry.at), ns(reached_));
  }

  // Rule 5: a serial SUT's interactions follow each other. Those of a concurrent SUT can end in
  // another order than they begin, each once.
  void check_sequence(const Logged<Interaction>& entry, SutSequences& sut) {
    const std::uint64_t sequence = entry.message.sequence;
    const bool is_new = sut.seen.insert(sequence).second;
    if (!sut.concurrent && sequence != sut.last + 1) {
      report_.add(5, entry, "interaction {} follows interaction {}", sequence, sut.last);
    } else if (sut.concurrent && !is_new) {
      report_.add(5, entry, "interaction {} occurs twice", sequence);
    }
    sut.last = sequence;
  }

  // Rule 5: only those calls of a concurrent SUT are missing that were open at its end.
  void check_missing(const std::string& uav, const SutSequences& sut) {
    if (!sut.concurrent || sut.seen.empty()) return;
    const std::uint64_t missing = *sut.seen.rbegin() - sut.seen.size();
    if (missing > kMostOpenCalls)
      report_.add({5,
                   uav,
                   0,
                   {},
                   fmt::format("{} interactions are missing, but at most {} calls can be open",
                               missing, kMostOpenCalls)});
  }

  // Rule 8: only a read that waits for its sensor's next measurement is held, a receive or a sleep,
  // and readings are of the state at release.
  void check_free_running(const Logged<Interaction>& entry) {
    const Interaction& message = entry.message;
    if (message.kind == record::kSensor) {
      check_free_reading(entry);
    } else if (message.kind == record::kSleep) {
      check_free_sleep(entry);
    } else if (message.kind != record::kReceive && message.st_at_release != message.st_at_arrival) {
      report_.add(8, entry, "held from ST {} to {} in a free-running record",
                  ns(message.st_at_arrival), ns(message.st_at_release));
    }
  }

  void check_free_sleep(const Logged<Interaction>& entry) {
    const Interaction& message = entry.message;
    if (!message.sleep_until) return report_.add(0, entry, "sleep without its end");
    const Wide wake =
        std::max(wide(message.st_at_arrival), grid_.at_or_after(wide(*message.sleep_until)));
    if (wide(message.st_at_release) != wake)
      report_.add(8, entry, "woken at ST {} instead of ST {}", ns(message.st_at_release), ns(wake));
  }

  void check_free_reading(const Logged<Interaction>& entry) {
    const Interaction& message = entry.message;
    const SimTime released = message.st_at_release, arrived = message.st_at_arrival;
    if (message.only_if_available && released != arrived)
      return report_.add(8, entry, "held from ST {} to {}, although the read must not wait",
                         ns(arrived), ns(released));
    if (message.only_if_available && !message.sampled_at) return;
    if (!message.sample_state_at || !message.sampled_at)
      return report_.add(0, entry, "sensor reading without its times");
    if (wide(*message.sample_state_at) != grid_.at_or_before(wide(released)))
      report_.add(8, entry, "released at ST {} with the state at ST {}", ns(released),
                  ns(*message.sample_state_at));
    if (released != arrived && !has_waited_for_next(message))
      report_.add(8, entry, "held from ST {} to {}, which is not the sensor's next measurement",
                  ns(arrived), ns(released));
    taken_by_.try_emplace({message.uav, message.sensor, message.sample_index}, message.sequence);
  }

  // Whether a read was released when the measurement that it returned was due, and no earlier one
  // after its arrival was left for it. A measurement is available from the boundary of its instant
  // on, and the next read may wait from there.
  bool has_waited_for_next(const Interaction& message) const {
    const auto& sensors = record_.header.sensors;
    const auto sensor = std::ranges::find_if(sensors, [&](const record::SensorInfo& candidate) {
      return candidate.uav == message.uav && candidate.name == message.sensor;
    });
    if (sensor == sensors.end() || !sensor->periodic || sensor->period <= Duration(0)) return false;
    const auto instant = [&](std::uint64_t index) {
      return wide(sensor->phase) + Wide{index} * wide(sensor->period);
    };
    const Wide due = instant(message.sample_index);
    const auto before = arrived_before(*sensor, message.sample_index);
    const bool is_next = !before ||
                         grid_.at_or_before(instant(*before)) <= wide(message.st_at_arrival) ||
                         has_earlier_request(message, *before);
    return wide(*message.sampled_at) == due && is_next &&
           grid_.at_or_before(due) == wide(message.st_at_release);
  }

  // The newest measurement before `index` that the driver did not lose.
  std::optional<std::uint64_t> arrived_before(const record::SensorInfo& sensor,
                                              std::uint64_t index) const {
    const DriverDraws driver(record_.header, sensor);
    while (index-- > 0)
      if (!driver.loses(index)) return index;
    return std::nullopt;
  }

  // Threads that wait for the same sensor get different measurements, in the order of requests.
  bool has_earlier_request(const Interaction& message, std::uint64_t index) const {
    const auto taken = taken_by_.find({message.uav, message.sensor, index});
    return taken != taken_by_.end() && taken->second < message.sequence;
  }

  void visit(const Logged<CommandEffect>& entry) {
    const CommandEffect& message = entry.message;
    check_log_time(entry, message.applied_at);
    if (!std::isfinite(message.vx_H_m_s + message.vy_H_m_s + message.vz_H_m_s +
                       message.yaw_rate_rad_s))
      report_.add(0, entry, "command that is not finite");
    check_order(entry);
    reached_ = std::max(reached_, entry.at);
  }

  void visit(const Logged<GroundTruth>& entry) {
    const GroundTruth& message = entry.message;
    check_log_time(entry, message.at);
    if (!suts_.contains(message.uav))
      return report_.add(0, entry, "no UAV \"{}\" in the record's header", message.uav);
    check_order(entry);
    check_instant(entry);
    check_state(entry);
    reached_ = std::max(reached_, entry.at);
  }

  void visit(const Logged<record::Annotation>& entry) {
    check_order(entry);
    reached_ = std::max(reached_, entry.at);
  }

  void visit(const Logged<record::Stop>& entry) {
    const auto sut = suts_.find(entry.message.uav);
    if (sut == suts_.end() || !sut->second.concurrent)
      report_.add(0, entry, "stop of a SUT that is not concurrent");
    if (record_.header.policy == record::kFreeRunning)
      report_.add(0, entry, "stop in a free-running record");
    check_order(entry);
    reached_ = std::max(reached_, entry.at);
  }

  void visit(const Logged<record::Contact>& entry) {
    const record::Contact& message = entry.message;
    if (!suts_.contains(message.uav))
      report_.add(0, entry, "no UAV \"{}\" in the record's header", message.uav);
    if (!record_.header.reports_contacts)
      report_.add(0, entry, "contact in a record that reports none");
    if (!grid_.contain(wide(message.at)) || message.at > entry.at)
      report_.add(0, entry, "contact at {}, recorded at ST {}", ns(message.at), ns(entry.at));
    if (!(std::isfinite(message.speed_m_s) && message.speed_m_s >= 0.0))
      report_.add(0, entry, "contact at {} m/s", message.speed_m_s);
    check_order(entry);
    reached_ = std::max(reached_, entry.at);
  }

  // Ground truth k is at the first boundary from k·period on; without a period, its times increase.
  void check_instant(const Logged<GroundTruth>& entry) {
    TruthRow& row = truth_[entry.message.uav];
    const Wide at = wide(entry.message.at);
    const Wide period = wide(record_.header.ground_truth_period);
    const Wide expected = grid_.at_or_after(row.count * period);
    if (!grid_.contain(at)) {
      report_.add(0, entry, "ground truth at {}, which is not a step boundary", ns(at));
    } else if (period > 0 && at != expected) {
      report_.add(0, entry, "ground truth at {}, expected at {}", ns(at), ns(expected));
    } else if (row.count > 0 && at <= row.last) {
      report_.add(0, entry, "ground truth at {} follows that at {}", ns(at), ns(row.last));
    }
    ++row.count;
    row.last = at;
  }

  void check_state(const Logged<GroundTruth>& entry) {
    const GroundTruth& message = entry.message;
    double sum = 0.0, square = 0.0;
    for (int i = 0; i < 3; ++i)
      sum += message.p_WB_m[i] + message.v_WB_m_s[i] + message.w_WB_B_rad_s[i];
    for (const double q : message.q_WB) square += q * q;
    if (!std::isfinite(sum)) report_.add(0, entry, "ground truth that is not finite");
    if (!(std::abs(std::sqrt(square) - 1.0) <= kRotationTolerance))
      report_.add(0, entry, "rotation of length {:.6f}", std::sqrt(square));
  }

  struct TruthRow {
    Wide count = 0;
    Wide last = 0;
  };

  const record::Record& record_;
  const Boundaries& grid_;
  Report& report_;
  std::map<std::string, SutSequences> suts_;
  std::map<std::string, TruthRow> truth_;
  // In a free-running record: the request that first read a measurement.
  std::map<std::tuple<std::string, std::string, std::uint64_t>, std::uint64_t> taken_by_;
  SimTime reached_{};
  WallTime wall_at_last_release_;
};

}  // namespace

void check_consistency(const record::Record& record, const Boundaries& grid, Report& report) {
  ConsistencyCheck(record, grid, report).run();
}

}  // namespace tether::audit
