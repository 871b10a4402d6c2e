#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <tether/base/time.h>
#include <tether/uav/camera_model.h>
#include <tether/uav/math.h>
#include <tether/uav/multirotor.h>
#include <tether/uav/samples.h>

/// What the host and a simulator outside of its process say to each other
/// (docs/guide/simulator-protocol.md). The host asks, the simulator answers each request with one
/// reply, in order. SI units; W is ENU, B is FLU.
///
/// The simulator provides what happens in the world: motion, distances along rays, ideal pictures.
/// What sensors make of that (delays, lens, shutter, noise) is the host's.
namespace tether::sim::protocol {

/// Of these messages. A simulator refuses an Open with another one.
inline constexpr std::uint32_t kVersion = 1;

/// A UAV that the simulator adds to the world.
struct UavDescription {
  std::string name;
  /// An SDF 1.6 document with one <model> of that name with one <link> "base_link", whose frame is
  /// B: mass, inertia, collisions, visuals; no joint, no sensor. The model's pose is `X_WB`.
  std::string sdf;
  uav::Pose X_WB;                      ///< at ST 0, hovering
  uav::MultirotorParameters airframe;  ///< for `uav::step`
};

/// A link of a dynamic model of the world.
struct BodyName {
  std::string model;  ///< "outer::inner" of nested ones
  std::string link;
};

/// How a visual of the world looks where the simulator's own reading of SDF does not show it:
/// Tether's textures (docs/guide/scenario.md).
struct Look {
  std::string model;
  std::string link;
  std::string visual;
  uav::Vec3 ambient_rgb, diffuse_rgb, specular_rgb, emissive_rgb;  ///< each 0..1
  std::string texture;                                             ///< absolute path of a PNG
  double texture_repeat_x = 1.0;  ///< repetitions per metre of surface
  double texture_repeat_y = 1.0;
  double alpha = 1.0;  ///< 0: not to be seen, 1: opaque
};

/// The first request. The simulator has the world loaded, or loads it now, adds the UAVs, and
/// stands at ST 0. Answered by Opened.
struct Open {
  std::uint32_t version = kVersion;
  std::string world_name;
  std::string world_file;  ///< absolute path of the user's SDF file
  double gravity_m_s2 = 9.81;
  Duration step{0};
  std::vector<UavDescription> uavs;
  /// What moves beside the UAVs. Everywhere below, "body" is an index into the UAVs, then these.
  std::vector<BodyName> bodies;
  /// State::past has at most so many.
  std::uint32_t past_steps = 0;
  /// Whether Render is going to be asked for, and of which size at most; 0: it is not.
  std::int32_t max_width_px = 0;
  std::int32_t max_height_px = 0;
  std::vector<Look> looks;
};

/// Back to ST 0, UAVs hovering at their start poses. `seed` is for what the simulator itself draws
/// at random. Answered by State.
struct Reset {
  std::uint64_t seed = 0;
};

struct Command {
  std::uint32_t uav = 0;
  uav::VelocityCommand command;
};

/// Sets the commands that the UAVs follow from now on, then steps until ST is `to`: at a step
/// boundary, not before now. Answered by State.
struct Advance {
  SimTime to;
  std::vector<Command> commands;
};

/// Casts rays from S in a world whose bodies are where `X_WB` says, whatever their poses are now.
/// Rays meet collision shapes. Answered by Distances.
struct CastRays {
  std::vector<uav::Pose> X_WB;           ///< of each body
  std::optional<std::uint32_t> carrier;  ///< a body that no ray meets
  uav::Pose X_WS;
  std::vector<uav::Vec3> rays_S;  ///< unit vectors in S's frame
  double max_m = 0.0;             ///< what is farther need not be found
};

/// Draws the world with its bodies where `X_WB` says, as a pinhole camera without distortion sees
/// it. Answered by Picture.
struct Render {
  uav::CameraModel camera;  ///< fx = fy; the principal point may be anywhere
  double near_m = 0.05;
  double far_m = 100.0;
  uav::Pose X_WS;  ///< of the camera: x ahead, y left, z up
  std::vector<uav::Pose> X_WB;
  std::optional<std::uint32_t> hidden;  ///< a body that is not drawn
  bool with_depth = false;
};

using Request = std::variant<Open, Reset, Advance, CastRays, Render>;

/// What the UAV's IMU needs: the mean over the last step; 0 at ST 0.
struct Motion {
  uav::Vec3 a_WB_W;      ///< acceleration of B's origin [m/s²]
  uav::Vec3 alpha_WB_B;  ///< angular acceleration [rad/s²]
};

/// The world at a step boundary.
struct State {
  SimTime now;
  std::vector<uav::BodyState> bodies;
  std::vector<Motion> motions;  ///< of each UAV
  /// Poses of all bodies when each of the last steps of this advance began, oldest first:
  /// min(steps, Open::past_steps) times the number of bodies.
  std::vector<uav::Pose> past;
};

struct Opened {
  std::string description;  ///< name and version, for the record: "Gazebo 11.1.0, ODE"
  State state;
};

struct Distances {
  std::vector<double> distance_m;  ///< of each ray; +inf: nothing
};

struct Picture {
  std::int32_t width_px = 0;
  std::int32_t height_px = 0;
  std::vector<std::uint8_t> rgb;  ///< rows from the top down, R, G, B in sRGB
  /// Of the nearest thing in the picture, along the camera's axis; only `with_depth` [m].
  double nearest_depth_m = 0.0;
  std::string renderer;  ///< name, for the record: "llvmpipe (LLVM 11.0.1, 256 bits)"
};

/// The request could not be served. There is no way on: the host hangs up.
struct Failed {
  std::string message;  ///< one line
};

using Reply = std::variant<Opened, State, Distances, Picture, Failed>;

}  // namespace tether::sim::protocol
