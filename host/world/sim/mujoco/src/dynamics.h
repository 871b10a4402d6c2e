#pragma once

#include "engine.h"
#include "meshes/mesh_file.h"

#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <tether/base/time.h>
#include <tether/sim/bodies.h>
#include <tether/sim/contacts.h>
#include <tether/sim/world.h>
#include <tether/sim_sensing/state_layout.h>
#include <tether/uav/multirotor.h>
#include <tether/uav/wind.h>

namespace tether::sim {

/// The moving part of the world: rigid bodies, contacts, rotors and controllers.
class Dynamics {
 public:
  /// `world` must outlive this object.
  Dynamics(const World& world, const WarningSink& warn, const MeshFiles& meshes = MeshFiles());

  /// Start poses, UAVs hovering, zero commands. `seed` keys the gusts. Allocates nothing.
  void reset(std::uint64_t seed);
  void set_setpoint(std::size_t uav, const uav::Setpoint& setpoint);
  /// One step: controllers and rotors see the state at its beginning, the engine does the rest. The
  /// engine divides it where a UAV moves so far that it would pass something without a contact.
  /// Allocates nothing.
  /// @throws Error(kSetup) when the engine finds the state unusable (not finite or out of bounds).
  void step();

  /// As StateRecorder does.
  void capture(std::vector<double>& state) const;
  uav::BodyState body_state(std::size_t uav) const;
  std::span<const double> joints_rad(std::size_t uav) const {
    return recorder_.joints().angles_rad(uav);
  }
  const mjModel& model() const { return *model_; }
  std::optional<Clearance> clearance(std::size_t uav) const { return meter_.measure(uav, X_WB_); }
  void warn_of_falls(const WarningSink& warn) { meter_.warn_of_falls(X_WB_, warn); }
  /// The contacts of UAVs in the steps so far.
  ContactLog& contacts() { return contacts_; }
  /// Whether more contacts occurred at once than the engine keeps; those were ignored.
  bool contacts_dropped() const;
  std::optional<energy::Status> battery(std::size_t uav) const;
  void computing(std::size_t uav, double cores);

 private:
  struct Flight {
    uav::Multirotor multirotor;
    uav::Setpoint setpoint;
    uav::MultirotorState state;
    uav::Gusts gusts;
    std::optional<energy::Meter> meter{};
    uav::Vec3 force_W{}, torque_W{};  ///< of the rotors, in this step
    double load_kg = 0.0;             ///< what it carries
    double half_thickness_m = 0.0;    ///< of its thickest shape; 0: it has none
  };

  void fly(std::size_t uav);
  void carry(std::size_t uav);
  void apply_rotors(std::size_t uav);
  std::int64_t parts_of_step() const;
  void step_engine(SimTime from, SimTime until, SimTime seen_at);
  void drive(SimTime from);
  void place_driven(SimTime at);
  void log_contacts(SimTime seen_at);
  uav::Vec3 velocity_before(int engine_body, const uav::Vec3& p_W) const;
  void check_engine() const;
  void read_engine();

  const World& world_;
  ModelPtr model_;
  DataPtr data_;
  DataPtr scratch_;  // for the engine's constants, once a mass changes; to clear it takes long
  std::vector<Flight> flights_;
  std::vector<std::pair<std::size_t, MovingBody>> driven_;  // with their numbers
  StateRecorder recorder_;
  std::vector<uav::Pose> X_WB_;      // of each of `moving_bodies`
  std::vector<BodyMotion> motions_;  // of each UAV
  std::vector<Shape> shapes_;
  std::vector<mjtNum> qvel_before_;  // at the beginning of the engine's last step
  ContactLog contacts_;
  ClearanceMeter meter_;
  SimTime now_{};
};

}  // namespace tether::sim
