#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <tether/base/result.h>

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

}  // namespace tether::mission
