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
#include <tether/uav/setpoint.h>

/// The messages between the host and an external simulator (docs/guide/simulator-protocol.md). The
/// simulator answers each request of the host with one reply, in order. SI units; W is ENU, B is
/// FLU.
///
/// The simulator provides motion, distances along rays and ideal pictures. The host makes the
/// samples from them (delays, lens, shutter, noise).
namespace tether::sim::protocol {

/// Version of these messages. A simulator refuses an Open of another version.
inline constexpr std::uint32_t kVersion = 1;

/// A UAV that the simulator must add to the world.
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

/// The material of a visual with a texture, which simulators do not read from SDF as Tether does
/// (docs/guide/scenario.md). `Look` in the schema.
struct VisualMaterial {
  std::string model;
  std::string link;
  std::string visual;
  uav::Vec3 ambient_rgb, diffuse_rgb, specular_rgb, emissive_rgb;  ///< each 0..1
  std::string texture;                                             ///< absolute path of a PNG
  double texture_repeat_x = 1.0;  ///< repetitions per metre of surface
  double texture_repeat_y = 1.0;
  double alpha = 1.0;  ///< 0: invisible, 1: opaque
};

/// The first request. The simulator loads the world, unless it has it loaded, adds the UAVs, and
/// stops at ST 0. Answered by Opened.
struct Open {
  std::uint32_t version = kVersion;
  std::string world_name;
  std::string world_file;  ///< absolute path of the user's SDF file
  double gravity_m_s2 = 9.81;
  Duration step{0};
  std::vector<UavDescription> uavs;
  /// Moving bodies other than the UAVs. Below, "body" is an index into the UAVs, then these.
  std::vector<BodyName> bodies;
  /// Maximum number of steps in State::past.
  std::uint32_t past_steps = 0;
  /// Maximum size of pictures; 0: there will be no Render.
  std::int32_t max_width_px = 0;
  std::int32_t max_height_px = 0;
  std::vector<VisualMaterial> materials;  ///< `looks` in the schema
};

/// Back to ST 0, UAVs hovering at their start poses. `seed` is for the simulator's own random
/// numbers. Answered by State.
struct Reset {
  std::uint64_t seed = 0;
};

struct Command {
  std::uint32_t uav = 0;
  uav::VelocityCommand command;
};

/// Any other set-point.
struct SetpointCommand {
  std::uint32_t uav = 0;
  uav::Setpoint setpoint;
};

/// Sets the commands that the UAVs follow from now on, then steps until ST is `to`: at a step
/// boundary, not before now. Answered by State.
struct Advance {
  SimTime to;
  std::vector<Command> commands;
  std::vector<SetpointCommand> setpoints{};  ///< only if Opened::takes_setpoints
};

/// Casts rays from S at collision shapes, with the bodies at the poses `X_WB` instead of their
/// current ones. Answered by Distances.
struct CastRays {
  std::vector<uav::Pose> X_WB;           ///< of each body
  std::optional<std::uint32_t> carrier;  ///< a body that rays do not hit
  uav::Pose X_WS;
  std::vector<uav::Vec3> rays_S;  ///< unit vectors in S's frame
  double max_m = 0.0;             ///< objects farther away may be ignored
};

/// Draws the world with its bodies at the poses `X_WB`, as seen by a pinhole camera without
/// distortion. Answered by Picture.
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

/// Accelerations for a UAV's IMU: means over the last step; 0 at ST 0.
struct Motion {
  uav::Vec3 a_WB_W;      ///< acceleration of B's origin [m/s²]
  uav::Vec3 alpha_WB_B;  ///< angular acceleration [rad/s²]
};

/// A UAV touches a collision shape of something else at a step boundary.
struct Touch {
  SimTime at;               ///< step boundary: from the beginning to the end of the advance
  std::uint32_t uav = 0;    ///< index into Open::uavs
  std::string with;         ///< name of the model ("outer::inner" of nested ones) or UAV
  std::uint32_t shape = 0;  ///< a number of the shape, unique in `with`
  /// Speed at which both approach each other along the contact's normal, before the impact [m/s];
  /// negative if they depart.
  double speed_m_s = 0.0;
};

/// The world at a step boundary.
struct State {
  SimTime now;
  std::vector<uav::BodyState> bodies;
  std::vector<Motion> motions;  ///< of each UAV
  /// Poses of all bodies at the beginning of each of the last steps of this advance, oldest first:
  /// min(steps, Open::past_steps) times the number of bodies.
  std::vector<uav::Pose> past;
  /// During this advance, one for each UAV, shape and step for which they touch, in the order of
  /// time. Empty unless Opened::reports_contacts.
  std::vector<Touch> touches{};
};

struct Opened {
  std::string description;  ///< name and version, for the record: "Gazebo 11.1.0, ODE"
  State state;
  bool reports_contacts = false;  ///< State::touches has everything that UAVs touch
  bool takes_setpoints = false;   ///< else only velocities in the heading frame
};

struct Distances {
  std::vector<double> distance_m;  ///< of each ray; +inf: nothing
};

struct Picture {
  std::int32_t width_px = 0;
  std::int32_t height_px = 0;
  std::vector<std::uint8_t> rgb;  ///< rows from the top down, R, G, B in sRGB
  /// Of the nearest object in the picture, along the camera's axis; only `with_depth` [m].
  double nearest_depth_m = 0.0;
  std::string renderer;  ///< name, for the record: "llvmpipe (LLVM 11.0.1, 256 bits)"
};

/// The request could not be served. The host then closes the connection.
struct Failed {
  std::string message;  ///< one line
};

using Reply = std::variant<Opened, State, Distances, Picture, Failed>;

}  // namespace tether::sim::protocol
