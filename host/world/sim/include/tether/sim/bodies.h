#pragma once

#include <cstddef>
#include <vector>

#include <tether/sim/world.h>

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

}  // namespace tether::sim
