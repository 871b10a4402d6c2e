#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

#include <tether/base/time.h>
#include <tether/energy/battery.h>
#include <tether/energy/propulsion.h>
#include <tether/uav/multirotor.h>

/// The energy of a UAV: what its rotors, its computer and its sensors draw from its battery. Pure.
namespace tether::energy {

/// What energy is spent on.
enum class Cause {
  kLift,        ///< what hovering takes
  kMoving,      ///< the rotors beyond that; negative where flying ahead takes less than hovering
  kIdle,        ///< the computer, as long as it is on
  kComputing,   ///< the computer's busy cores
  kSensors,     ///< sensors, radio and whatever else draws a constant power
  kResistance,  ///< heat of the battery's internal resistance
};
inline constexpr std::size_t kCauses = 6;
/// "lift", "moving", "idle", "computing", "sensors", "resistance".
std::string_view name(Cause cause);
using Energies_J = std::array<double, kCauses>;  ///< by Cause

struct Computer {
  double idle_W = 0.0;
  double busy_core_W = 0.0;  ///< what a core that computes takes more
  friend bool operator==(const Computer&, const Computer&) = default;
};

struct Model {
  Propulsion propulsion;
  Battery battery;
  Computer computer;
  double sensors_W = 0.0;  ///< sensors and radio
};

/// At one instant.
struct Status {
  double voltage_V = 0.0;
  double current_A = 0.0;
  double charge = 1.0;                ///< share of the capacity
  Energies_J spent_J{};               ///< since ST 0
  std::optional<SimTime> empty_at{};  ///< when the battery was exhausted; the rotors have no power
                                      ///< since
  friend bool operator==(const Status&, const Status&) = default;
};

/// Follows one UAV through a run. A value; allocates nothing per step.
class Meter {
 public:
  /// `model` and `airframe` must outlive it. At ST 0.
  Meter(const Model& model, const uav::MultirotorParameters& airframe, double gravity_m_s2);

  /// From now on, so many of the computer's cores are busy.
  void computing(double cores) { busy_cores_ = cores; }
  /// One step from `from` on, with the state at its beginning.
  void step(SimTime from, Duration dt, const uav::BodyState& body,
            const uav::MultirotorState& rotors);

  /// What the battery's voltage leaves of the greatest rotor speed; in [0, 1].
  double speed_limit() const;
  const Status& status() const { return status_; }

 private:
  const Model* model_;
  const uav::MultirotorParameters* airframe_;
  double hover_W_;
  double busy_cores_ = 0.0;
  Status status_;
};

}  // namespace tether::energy
