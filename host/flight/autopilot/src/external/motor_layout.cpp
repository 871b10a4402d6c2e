#include "external/motor_layout.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <tether/base/units.h>

namespace tether::autopilot {
namespace {

struct Motor {
  double angle_deg = 0.0;  ///< from ahead, clockwise seen from above
  int direction = 0;       ///< as Rotor::direction
};
constexpr int kCcw = 1, kCw = -1;

// In the order of ArduPilot's numbers.
constexpr Motor kQuadPlus[] = {{90, kCcw}, {-90, kCcw}, {0, kCw}, {180, kCw}};
constexpr Motor kQuadX[] = {{45, kCcw}, {-135, kCcw}, {-45, kCw}, {135, kCw}};
constexpr Motor kQuadH[] = {{45, kCw}, {-135, kCw}, {-45, kCcw}, {135, kCcw}};
constexpr Motor kHexaPlus[] = {{0, kCw},   {180, kCcw}, {-120, kCw},
                               {60, kCcw}, {-60, kCcw}, {120, kCw}};
constexpr Motor kHexaX[] = {{90, kCw},   {-90, kCcw}, {-30, kCw},
                            {150, kCcw}, {30, kCcw},  {-150, kCw}};
constexpr Motor kOctaPlus[] = {{0, kCw},    {180, kCw},   {45, kCcw}, {135, kCcw},
                               {-45, kCcw}, {-135, kCcw}, {-90, kCw}, {90, kCw}};
constexpr Motor kOctaX[] = {{22.5, kCw},   {-157.5, kCw},  {67.5, kCcw}, {157.5, kCcw},
                            {-22.5, kCcw}, {-112.5, kCcw}, {-67.5, kCw}, {112.5, kCw}};

struct MotorFrame {
  int frame_class, frame_type;
  std::span<const Motor> motors;
};
// "H" are rotors as those of "X" that turn the other way.
constexpr MotorFrame kMotorFrames[] = {{1, 0, kQuadPlus}, {1, 1, kQuadX}, {1, 3, kQuadH},
                                       {2, 0, kHexaPlus}, {2, 1, kHexaX}, {3, 0, kOctaPlus},
                                       {3, 1, kOctaX}};

bool is_motor(const Motor& motor, const uav::Rotor& rotor) {
  constexpr double kOff_deg = 10.0, kTurn_deg = 360.0;
  const double angle_deg = deg_from_rad(std::atan2(-rotor.p_BR.y, rotor.p_BR.x));
  return motor.direction == rotor.direction &&
         std::abs(std::remainder(motor.angle_deg - angle_deg, kTurn_deg)) < kOff_deg;
}

}  // namespace

std::optional<MotorLayout> motor_layout(const std::vector<uav::Rotor>& rotors) {
  for (const MotorFrame& frame : kMotorFrames) {
    MotorLayout layout{frame.frame_class, frame.frame_type, {}};
    for (const uav::Rotor& rotor : rotors) {
      const auto motor = std::ranges::find_if(
          frame.motors, [&](const Motor& candidate) { return is_motor(candidate, rotor); });
      if (motor == frame.motors.end()) break;
      layout.motors.push_back(static_cast<std::size_t>(motor - frame.motors.begin()));
    }
    if (layout.motors.size() == rotors.size() && rotors.size() == frame.motors.size())
      return layout;
  }
  return std::nullopt;
}

}  // namespace tether::autopilot
