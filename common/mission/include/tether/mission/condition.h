#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <tether/base/result.h>
#include <tether/mission/quantity.h>

namespace tether::mission {

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
