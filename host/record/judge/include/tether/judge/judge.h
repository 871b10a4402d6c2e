#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <tether/base/time.h>
#include <tether/mission/mission.h>
#include <tether/record/reader.h>

/// Judges the clauses of a mission from the record of a run: from the ground truth and from the
/// times of interactions. The SUT only marks when its tasks start and end (docs/guide/missions.md).
/// Pure functions.
namespace tether::judge {

/// When a task ran, with its repetitions.
struct TaskSpan {
  std::string uav;
  std::string task;
  SimTime from;
  SimTime to;          ///< of one that did not end, the end of the run
  std::string status;  ///< "reached", "not_reached", "failed", as the SUT says; or "unfinished"
  std::string reason;  ///< one line; may be empty

  friend bool operator==(const TaskSpan&, const TaskSpan&) = default;
};

/// The margin of a clause as it stood at one instant.
struct MarginAt {
  SimTime at;
  double margin = 0.0;

  friend bool operator==(const MarginAt&, const MarginAt&) = default;
};

/// Whether a clause is met, and by how much.
struct ClauseVerdict {
  std::string uav;
  std::string name;
  bool met = false;
  /// Its robustness: how much further the clause would have been met, or (negative) by how much it
  /// was missed, in `unit`. None if it could not be judged, which counts as missed.
  std::optional<double> margin{};
  std::string unit{};
  std::optional<SimTime> from{}, to{};  ///< what it is about; none if that did not happen
  std::optional<SimTime> deadline{};    ///< none if it has none
  std::optional<SimTime> decided_at{};  ///< when the verdict could no longer change
  std::string limited_by{};             ///< one line: what made the margin no larger
  /// How the margin developed, in `unit`, at no more than about 40 instants: the time that was
  /// left, the worst value so far (eventually: the best), or with a share each value.
  std::vector<MarginAt> margins{};
  /// Of a condition on commands or reads, such as `reaction_time`: the quantiles of its values at
  /// 0, 5, … 100 %, in `unit`. Empty for other clauses, and if there were none.
  std::vector<double> quantiles{};
  /// Of such a condition: the quantity ("reaction_time") and the sensor, if it names one.
  std::string quantity{}, sensor{};
  /// The bound of the condition, or the time from `from` to the deadline, in `unit`.
  std::optional<double> limit{};
  /// Of a reaction time, in `unit`: the least that passed without computing, until the program had
  /// the image, while it waited, and from its command until the effect; and the median of what it
  /// computed in between.
  std::optional<double> least_without_computing{}, median_of_computing{};

  friend bool operator==(const ClauseVerdict&, const ClauseVerdict&) = default;
};

struct Verdicts {
  std::vector<TaskSpan> tasks;         ///< in the order in which they began
  std::vector<ClauseVerdict> clauses;  ///< in the order of the mission
};

/// The verdicts on the flight of `uav`.
Verdicts judge(const mission::Mission& mission, const std::string& uav,
               const record::Record& record);

/// Finds during a flight whether a clause that ends it (`ends_flight`) is missed, from the ground
/// truth of its UAV up to the `finish` of its SUT. Depends on the messages only, so that a flight
/// ends at the same instant whenever this looks. Not thread-safe.
class FlightWatch {
 public:
  struct Miss {
    SimTime at;
    std::string reason;  ///< one line
  };

  /// `record` grows during the flight. All must outlive this.
  FlightWatch(const mission::Mission& mission, std::string uav, const record::Record& record)
      : mission_(mission), uav_(std::move(uav)), record_(record) {}

  /// The first miss in what was added since the last look.
  std::optional<Miss> look();

 private:
  std::optional<Miss> first_miss(const mission::Clause& clause,
                                 const std::vector<const record::GroundTruth*>& truths) const;

  const mission::Mission& mission_;
  std::string uav_;
  const record::Record& record_;
  std::size_t next_truth_ = 0, next_interaction_ = 0;
  SimTime finished_at_ = SimTime::max();
  std::optional<record::GroundTruth> start_;
};

}  // namespace tether::judge
