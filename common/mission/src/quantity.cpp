#include <algorithm>
#include <array>

#include <tether/base/units.h>
#include <tether/mission/mission.h>

namespace tether::mission {

std::span<const Unit> units() {
  static constexpr std::array kUnits = {
      Unit{"m", Dimension::kLength},
      Unit{"cm", Dimension::kLength, 1e-2},
      Unit{"deg", Dimension::kAngle, rad_from_deg(1.0)},
      Unit{"rad", Dimension::kAngle},
      Unit{"s", Dimension::kTime},
      Unit{"ms", Dimension::kTime, 1e-3},
      Unit{"m/s", Dimension::kSpeed},
      Unit{"deg/s", Dimension::kYawRate, rad_from_deg(1.0)},
      Unit{"rad/s", Dimension::kYawRate},
      Unit{"J", Dimension::kEnergy},
      Unit{"kJ", Dimension::kEnergy, 1e3},
      Unit{"Wh", Dimension::kEnergy, 3600.0},
      Unit{"%", Dimension::kShare, 1e-2},
  };
  return kUnits;
}

std::span<const Quantity> quantities() {
  static constexpr std::array kQuantities = {
      Quantity{"bearing_error", Dimension::kAngle, Subject::kAnchor, false,
               "horizontal angle between the UAV's heading and the anchor, without sign"},
      Quantity{"distance", Dimension::kLength, Subject::kAnchor, false,
               "horizontal distance from the UAV to the anchor's centre"},
      Quantity{"separation", Dimension::kLength, Subject::kAnchor, false,
               "distance from the UAV to the anchor's centre, height included"},
      Quantity{"from_start", Dimension::kLength, Subject::kNone, false,
               "horizontal distance from the UAV to where it began"},
      Quantity{"inside", Dimension::kLength, Subject::kFence, false,
               "horizontal distance from the UAV to the nearest edge of a fence; negative outside"},
      Quantity{"x", Dimension::kLength, Subject::kNone, false, "x of the UAV in the world"},
      Quantity{"y", Dimension::kLength, Subject::kNone, false, "y of the UAV in the world"},
      Quantity{"altitude", Dimension::kLength, Subject::kNone, false, "z of the UAV in the world"},
      Quantity{"speed", Dimension::kSpeed, Subject::kNone, false, "size of the UAV's velocity"},
      Quantity{"yaw_rate", Dimension::kYawRate, Subject::kNone, false,
               "rotation about the vertical, without sign"},
      Quantity{"clearance", Dimension::kLength, Subject::kNone, false,
               "distance from the UAV to the nearest surface, such as a wall"},
      Quantity{"energy_j", Dimension::kEnergy, Subject::kNone, false,
               "what the battery lost since the start of the time that the clause is about"},
      Quantity{"charge_left", Dimension::kShare, Subject::kNone, false,
               "charge of the battery as a share of its capacity"},
      Quantity{"delivery_ratio", Dimension::kShare, Subject::kNone, false,
               "share of the UAV's messages so far that arrived; 100 % before the first"},
      Quantity{"information_age", Dimension::kTime, Subject::kNone, false,
               "since the newest message that has arrived was sent; from the start without any"},
      Quantity{"reaction_time", Dimension::kTime, Subject::kSensor, true,
               "from the instant of the newest image to the effect of a command, for each command"},
      Quantity{"data_age", Dimension::kTime, Subject::kSensor, true,
               "from the instant of the newest sample to a command, for each command"},
      Quantity{"loop_period", Dimension::kTime, Subject::kSensor, true,
               "from read to read of a sensor; without a sensor, from command to command"},
      Quantity{"loop_jitter", Dimension::kTime, Subject::kSensor, true,
               "difference between a loop_period and their mean, without sign"},
  };
  return kQuantities;
}

const Quantity* find_quantity(std::string_view name) {
  const std::span<const Quantity> all = quantities();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Quantity& q) { return q.name == name; });
  return found == all.end() ? nullptr : &*found;
}

}  // namespace tether::mission
