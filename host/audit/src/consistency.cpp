#include "checks.h"
#include "file_order.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>

namespace tether::audit {
namespace {

using record::CommandEffect;
using record::GroundTruth;
using record::Interaction;
using record::Logged;

bool is_known_kind(std::string_view kind) {
  return kind == record::kSensor || kind == record::kCommand || kind == record::kSleep ||
         kind == record::kFinish;
}

// How far from 1 the length of a rotation may be.
constexpr double kRotationTolerance = 1e-6;

// Calls of one SUT that may be open at once (DESIGN section 2).
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
    for (const record::SutInfo& sut : record.header.suts) {
      suts_[sut.uav].concurrent = sut.concurrent;
    }
  }

  void run() {
    if (suts_.size() != record_.header.suts.size()) {
      report_.add("two SUTs fly one UAV");
    }
    for_each_in_file_order(record_, [&](const auto& entry) { visit(entry); });
    for (const auto& [uav, sut] : suts_) {
      check_missing(uav, sut);
    }
  }

 private:
  void visit(const Logged<Interaction>& entry) {
    const Interaction& message = entry.message;
    if (entry.at != message.st_at_release) {
      report_.add(0, entry,
                  "logged at ST " + ns(wide(entry.at)) + ", released at " +
                      ns(wide(message.st_at_release)));
    }
    if (!is_known_kind(message.kind)) {
      report_.add(0, entry, "unknown kind \"" + message.kind + "\"");
    }
    if (record_.header.policy == record::kFreeRunning) {
      check_free_running(entry);
    }
    const auto sut = suts_.find(message.uav);
    if (sut == suts_.end()) {
      return report_.add(0, entry, "no UAV \"" + message.uav + "\" in the record's header");
    }
    check_sequence(entry, sut->second);
    reached_ = std::max(reached_, wide(entry.at));
  }

  // Rule 5: a serial SUT's interactions follow each other; those of a concurrent one end in another
  // order than they begin, each once.
  void check_sequence(const Logged<Interaction>& entry, SutSequences& sut) {
    const std::uint64_t sequence = entry.message.sequence;
    const bool is_new = sut.seen.insert(sequence).second;
    if (!sut.concurrent && sequence != sut.last + 1) {
      report_.add(5, entry,
                  "interaction " + std::to_string(sequence) + " follows interaction " +
                      std::to_string(sut.last));
    } else if (sut.concurrent && !is_new) {
      report_.add(5, entry, "interaction " + std::to_string(sequence) + " is there twice");
    }
    sut.last = sequence;
  }

  // Rule 5: of a concurrent SUT only calls that were open at its end are missing.
  void check_missing(const std::string& uav, const SutSequences& sut) {
    if (!sut.concurrent || sut.seen.empty()) return;
    const std::uint64_t missing = *sut.seen.rbegin() - sut.seen.size();
    if (missing > kMostOpenCalls) {
      report_.add(
          {5,
           uav,
           0,
           {},
           std::to_string(missing) + " interactions are missing, more than can be open at once"});
    }
  }

  // Rule 8: nothing is held but a read that waits for its sensor's next measurement, and readings
  // are of the state at release. (Of a synchronised record, check_order sees to the log times.)
  void check_free_running(const Logged<Interaction>& entry) {
    const Interaction& message = entry.message;
    if (wide(entry.at) < reached_) {
      report_.add(0, entry, "logged at ST " + ns(wide(entry.at)) + ", after " + ns(reached_));
    }
    if (message.kind == record::kSensor) {
      check_free_reading(entry);
    } else if (message.st_at_release != message.st_at_arrival) {
      report_.add(8, entry,
                  "held from ST " + ns(wide(message.st_at_arrival)) + " to " +
                      ns(wide(message.st_at_release)) + " in a free-running record");
    }
  }

  void check_free_reading(const Logged<Interaction>& entry) {
    const Interaction& message = entry.message;
    const Wide released = wide(message.st_at_release);
    const Wide arrived = wide(message.st_at_arrival);
    if (message.only_if_available && released != arrived) {
      return report_.add(8, entry,
                         "held from ST " + ns(arrived) + " to " + ns(released) +
                             ", although it asked only for what was there");
    }
    if (message.only_if_available && !message.sampled_at) {
      return;
    }
    if (!message.sample_state_at || !message.sampled_at) {
      return report_.add(0, entry, "a sensor reading without its times");
    }
    if (wide(*message.sample_state_at) != grid_.at_or_before(released)) {
      report_.add(8, entry,
                  "released at ST " + ns(released) + " with the state of ST " +
                      ns(wide(*message.sample_state_at)));
    }
    if (released != arrived && !has_waited_for_next(message)) {
      report_.add(8, entry,
                  "held from ST " + ns(arrived) + " to " + ns(released) +
                      ", which is not when its sensor measured next");
    }
    taken_by_.try_emplace({message.uav, message.sensor, message.sample_index}, message.sequence);
  }

  // Whether a read was released just when the measurement that it says it got was due, and no
  // earlier one after its arrival that was not another's. A measurement is there at the boundary of
  // its instant: whoever read it may ask for the next one from there on.
  bool has_waited_for_next(const Interaction& message) const {
    const record::SensorInfo* sensor = find_sensor(message.uav, message.sensor);
    if (sensor == nullptr || !sensor->periodic || sensor->period <= Duration(0)) return false;
    const Wide due =
        wide(sensor->phase) + static_cast<Wide>(message.sample_index) * wide(sensor->period);
    const bool is_next =
        grid_.at_or_before(due - wide(sensor->period)) <= wide(message.st_at_arrival) ||
        message.sample_index == 0 || has_earlier_request(message, message.sample_index - 1);
    return wide(*message.sampled_at) == due && is_next &&
           grid_.at_or_before(due) == wide(message.st_at_release);
  }

  // Of threads that wait for the same sensor, each gets a measurement of its own, in their order.
  bool has_earlier_request(const Interaction& message, std::uint64_t index) const {
    const auto taken = taken_by_.find({message.uav, message.sensor, index});
    return taken != taken_by_.end() && taken->second < message.sequence;
  }

  const record::SensorInfo* find_sensor(const std::string& uav, const std::string& name) const {
    for (const record::SensorInfo& sensor : record_.header.sensors) {
      if (sensor.uav == uav && sensor.name == name) return &sensor;
    }
    return nullptr;
  }

  void visit(const Logged<CommandEffect>& entry) {
    const CommandEffect& message = entry.message;
    if (entry.at != message.applied_at) {
      report_.add(
          0, entry,
          "logged at ST " + ns(wide(entry.at)) + ", applied at " + ns(wide(message.applied_at)));
    }
    if (!std::isfinite(message.vx_H_m_s + message.vy_H_m_s + message.vz_H_m_s +
                       message.yaw_rate_rad_s)) {
      report_.add(0, entry, "a command that is not finite");
    }
    if (wide(entry.at) < reached_) {
      report_.add(0, entry, "logged at ST " + ns(wide(entry.at)) + ", after " + ns(reached_));
    }
    reached_ = std::max(reached_, wide(entry.at));
  }

  void visit(const Logged<GroundTruth>& entry) {
    const GroundTruth& message = entry.message;
    if (entry.at != message.at) {
      report_.add(entry,
                  "logged at ST " + ns(wide(entry.at)) + ", true at " + ns(wide(message.at)));
    }
    if (!suts_.contains(message.uav)) {
      return report_.add(entry, "no UAV \"" + message.uav + "\" in the record's header");
    }
    if (wide(entry.at) < reached_) {
      report_.add(entry, "logged at ST " + ns(wide(entry.at)) + ", after " + ns(reached_));
    }
    check_instant(entry);
    check_state(entry);
    reached_ = std::max(reached_, wide(entry.at));
  }

  void visit(const Logged<record::Annotation>& entry) {
    if (wide(entry.at) < reached_) {
      report_.add({0, entry.message.uav, 0, entry.at,
                   "annotation logged at ST " + ns(wide(entry.at)) + ", after " + ns(reached_)});
    }
    reached_ = std::max(reached_, wide(entry.at));
  }

  void visit(const Logged<record::Stop>& entry) {
    const auto sut = suts_.find(entry.message.uav);
    const auto finding = [&](std::string what) {
      report_.add({0, entry.message.uav, 0, entry.at, std::move(what)});
    };
    if (sut == suts_.end() || !sut->second.concurrent) {
      finding("a stop of a SUT that is not concurrent");
    }
    if (record_.header.policy == record::kFreeRunning) {
      finding("a stop in a free-running record");
    }
    if (wide(entry.at) < reached_) {
      finding("stop logged at ST " + ns(wide(entry.at)) + ", after " + ns(reached_));
    }
    reached_ = std::max(reached_, wide(entry.at));
  }

  // Ground truth k is that of the first boundary from k·period on; without a period it only grows.
  void check_instant(const Logged<GroundTruth>& entry) {
    TruthRow& row = truth_[entry.message.uav];
    const Wide at = wide(entry.message.at);
    const Wide period = wide(record_.header.ground_truth_period);
    if (!grid_.contain(at)) {
      report_.add(entry, "ground truth at " + ns(at) + ", no step boundary");
    } else if (period > 0 && at != grid_.at_or_after(row.count * period)) {
      report_.add(entry, "ground truth at " + ns(at) + ", expected at " +
                             ns(grid_.at_or_after(row.count * period)));
    } else if (row.count > 0 && at <= row.last) {
      report_.add(entry, "ground truth at " + ns(at) + " follows that at " + ns(row.last));
    }
    ++row.count;
    row.last = at;
  }

  void check_state(const Logged<GroundTruth>& entry) {
    double sum = 0.0;
    for (int i = 0; i < 3; ++i) {
      sum += entry.message.p_WB_m[i] + entry.message.v_WB_m_s[i] + entry.message.w_WB_B_rad_s[i];
    }
    double square = 0.0;
    for (const double q : entry.message.q_WB) {
      square += q * q;
    }
    if (!std::isfinite(sum)) {
      report_.add(entry, "ground truth that is not finite");
    }
    if (!(std::abs(std::sqrt(square) - 1.0) <= kRotationTolerance)) {
      report_.add(entry, "a rotation of length " + std::to_string(std::sqrt(square)));
    }
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
  // Of a free-running record: by whose request a measurement was first read.
  std::map<std::tuple<std::string, std::string, std::uint64_t>, std::uint64_t> taken_by_;
  Wide reached_ = 0;
};

}  // namespace

void check_consistency(const record::Record& record, const Boundaries& grid, Report& report) {
  ConsistencyCheck(record, grid, report).run();
}

}  // namespace tether::audit
