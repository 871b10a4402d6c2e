#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <tether/sim/world.h>
#include <tether/uav/math.h>

namespace tether::sim {

/// A body that moves: a UAV, or a link of a dynamic model. Its index in `moving_bodies` is its
/// number in every back end.
struct MovingBody {
  const Link* link = nullptr;
  const Uav* uav = nullptr;      ///< nullptr: a link of `model`
  const Model* model = nullptr;  ///< nullptr: a UAV
  uav::Pose X_WB;                ///< at ST 0
};

/// The UAVs in order, then the links of the dynamic models in order. Refers into `world`.
std::vector<MovingBody> moving_bodies(const World& world);
/// X_WB of a link at ST 0: a path may begin elsewhere than the model stands in its file.
uav::Pose start_of(const Model& model, const Link& link);

/// A part of a UAV behind `joints` of its joints. It is drawn as a body of its own.
struct TurnedPart {
  std::size_t uav;
  std::size_t joints;
};
/// One for each joint of each UAV in order: part i is drawn as the body after `moving_bodies` and i
/// more.
std::vector<TurnedPart> turned_parts(const World& world);

/// What drives a link of a driven model: its motion at an instant of ST.
struct DrivenState {
  uav::Pose X_WB;
  uav::Vec3 v_WB;        ///< [m/s]
  uav::Vec3 w_WB_W;      ///< about z [rad/s]
  uav::Vec3 a_WB;        ///< [m/s²]
  uav::Vec3 alpha_WB_W;  ///< [rad/s²]
};
/// @pre the body's model has a path
DrivenState driven_state(const MovingBody& body, SimTime at);

/// A link of a static model, with its fixed pose. Refers into the world.
struct FixedBody {
  const Link* link = nullptr;
  uav::Pose X_WB;
  const Model* model = nullptr;
};
std::vector<FixedBody> fixed_bodies(const World& world);

/// The joints of all UAVs: each turns at its rate to the angle that was commanded last. Their parts
/// weigh nothing, so that this is the same for every back end.
class JointDrives {
 public:
  explicit JointDrives(const World& world);

  void reset();
  /// @pre an angle for each joint of the UAV, within its limits
  void command(std::size_t uav, std::span<const double> angles_rad);
  void step();

  std::span<const double> angles_rad() const { return angles_rad_; }  ///< UAV by UAV
  std::span<const double> angles_rad(std::size_t uav) const;

 private:
  struct Drive {
    uav::Joint joint;
    double target_rad = 0.0;
  };
  std::vector<Drive> drives_;
  std::vector<double> angles_rad_;
  std::vector<std::size_t> first_;  // of each UAV, and the end
  double step_s_;
};

/// The rays that represent a rangefinder's field of view: a cone about x of the given full angle
/// [rad], as RangeModel::rays_S. The middle ray comes first; then four rings at a quarter, half,
/// three quarters and all of the half angle, with 6, 12, 18 and 24 evenly spaced rays, beginning
/// in the x-y plane on y's side. 0 gives the middle ray alone. Objects smaller than the gaps (an
/// eighth of the angle) can be missed.
///
/// @pre 0 ≤ field_of_view_rad ≤ π. Pure; safe from any thread.
std::vector<uav::Vec3> cone_of_rays(double field_of_view_rad);

}  // namespace tether::sim
