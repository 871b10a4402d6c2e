#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <tether/base/error.h>
#include <tether/base/result.h>
#include <tether/base/time.h>
#include <tether/toml/table.h>

/// What the clauses of a mission can be about.
namespace tether::mission {

enum class Dimension { kLength, kAngle, kTime, kSpeed, kYawRate, kEnergy, kShare };

/// A unit that people write.
struct Unit {
  std::string_view name;  ///< "deg/s"
  Dimension dimension;
  double si = 1.0;  ///< the value of one such unit in SI units

  // Of decimal parts of a unit the nearest number: 9 ms are 0.009 s, as 9,000,000 ns are.
  double to_si(double value) const { return si < 1.0 ? value / (1.0 / si) : value * si; }
  double from_si(double value) const { return si < 1.0 ? value * (1.0 / si) : value / si; }
};
std::span<const Unit> units();

/// What `of NAME` names in a condition.
enum class Subject {
  kNone,
  kAnchor,  ///< required, but for the file's own `anchor`
  kSensor,  ///< optional
  kFence,   ///< required
};

struct Quantity {
  std::string_view name;
  Dimension dimension;
  Subject subject = Subject::kNone;
  bool is_event = false;  ///< has values at commands or reads only, not at every instant
  std::string_view help;  ///< one line: the definition

  /// Of the battery: the record has it only if the UAV has a model of energy.
  bool needs_battery() const { return dimension == Dimension::kEnergy || name == "charge_left"; }
  /// Of the messages between UAVs.
  bool is_of_radio() const { return name == "delivery_ratio" || name == "information_age"; }
  /// Of the ground truth: known at each instant of the flight.
  bool is_of_truth() const { return !is_event && !needs_battery() && !is_of_radio(); }
  /// Its value is 0 at the start of the time of a clause.
  bool counts_from_start() const { return dimension == Dimension::kEnergy; }
};
/// All, in the order in which help lists them.
std::span<const Quantity> quantities();
/// nullptr if there is none of that name.
const Quantity* find_quantity(std::string_view name);

/// A corner of a fence, in the world.
struct Corner {
  double x_m = 0.0, y_m = 0.0;
};

/// A bound on a quantity: QUANTITY [of NAME] (<= | >=) NUMBER UNIT [in SHARE %].
struct Condition {
  const Quantity* quantity = nullptr;  ///< one of `quantities()`
  std::string of;                      ///< an anchor, a sensor or a fence; empty: none
  bool at_most = true;                 ///< else at least
  double bound = 0.0;                  ///< in `unit`
  const Unit* unit = nullptr;          ///< one of `units()`, of the quantity's dimension
  double share = 1.0;                  ///< of the time, or of the events; in (0, 1]
  std::vector<Corner> fence{};         ///< of a kFence: at least three, all the way round

  /// As written in a file.
  std::string text() const;
};

/// Fails (kInvalid) with what is wrong and what is allowed.
Result<Condition> parse_condition(std::string_view text);

// Mission files (docs/guide/missions.md): tasks with time constraints. The SUT flies the tasks;
// the host judges the clauses. Both read the file with this reader. The options of a task are
// those of the program that flies it (rig::load_mission).

/// What the SUT does after a task that did not reach its goal, or not by its deadline.
struct OnMiss {
  enum class Kind { kContinue, kAbort, kGoTo };
  Kind kind = Kind::kAbort;
  std::size_t task = 0;  ///< of kGoTo: index of a later task

  friend bool operator==(const OnMiss&, const OnMiss&) = default;
};

struct Task {
  std::string name;  ///< unique; by default its kind
  std::string kind;  ///< "face_anchor"
  OnMiss on_miss;
  bool acts_on_lateness = false;   ///< `on_miss` is given: it also applies to a late goal
  int retry = 0;                   ///< how often it is repeated if it does not reach its goal
  std::optional<Duration> within;  ///< its deadline, from its start
  std::optional<Duration> before;  ///< its deadline, from the mission's start
};

/// A requirement that the host judges.
struct Clause {
  enum class Kind {
    kDeadline,    ///< the tasks end with their goals reached by the deadline
    kAlways,      ///< the condition holds throughout
    kNever,       ///< the condition never holds
    kEventually,  ///< the condition holds at some time, for `hold`, and by the deadline
  };
  std::string name;  ///< unique; by default its text
  FileLocation where;
  Kind kind = Kind::kDeadline;
  std::optional<Condition> condition;  ///< none of kDeadline
  /// The tasks that it is about: first to last. None: the whole mission.
  std::optional<std::pair<std::size_t, std::size_t>> during;
  std::optional<std::size_t> after;  ///< from the end of this task to the end of the mission
  Duration hold{0};
  std::optional<Duration> within;  ///< from the start of what it is about
  std::optional<Duration> before;  ///< from the start of the mission
  /// The flight ends where the condition is first missed. Only of kAlways and kNever without a
  /// share, about the whole mission and a quantity of the ground truth.
  bool ends_flight = false;
};

struct Mission {
  std::string file;
  std::vector<Task> tasks;      ///< at least one
  std::vector<Clause> clauses;  ///< of the tasks' deadlines first, then as in the file
};

/// The keys of a [[task]] that are not options of a task.
std::span<const std::string_view> task_keys();

/// @throws Error(kBadFile) with file and line, about the key. @pre `file` is the top of a file.
Mission read_mission(const toml::Table& file);
/// @throws Error(kBadFile) as above.
Mission load_mission(const std::filesystem::path& file);

/// What a mission can refer to.
struct Surroundings {
  std::vector<std::string> anchors;
  Duration time_limit{0};    ///< of the run
  bool has_battery = false;  ///< the UAV has a model of energy
};
/// @throws Error(kBadFile) at a clause that no run can meet: it names another anchor, is
/// about a battery that the UAV does not have, or its deadline is beyond the time limit.
void require_possible(const Mission& mission, const Surroundings& surroundings);

}  // namespace tether::mission
