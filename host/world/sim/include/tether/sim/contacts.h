#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <tether/base/time.h>
#include <tether/sim/world.h>

namespace tether::sim {

/// A UAV has begun to touch something.
struct Contact {
  SimTime at;           ///< the step boundary at which both touch for the first time
  std::size_t uav = 0;  ///< index in `World::uavs`
  std::string with;     ///< name of the model or UAV that it touches
  /// Speed at which both approached each other along the contact's normal, just before the impact
  /// [m/s], ≥ 0. A UAV that slides along a wall has a speed near 0.
  double speed_m_s = 0.0;
  friend bool operator==(const Contact&, const Contact&) = default;
};

/// A collision shape that a UAV touches at a step boundary.
struct Touch {
  SimTime at;
  std::size_t uav = 0;
  std::string_view with;   ///< must outlive the log
  std::int64_t shape = 0;  ///< a number of the shape that is touched, unique in `with`
  double speed_m_s = 0.0;  ///< as Contact::speed_m_s; ≤ 0: both depart
};

/// Makes contacts of the touches of every step. What touches again within kSameContact after it
/// was last touched is still the same contact. Several shapes of one model (boards of a shelf, the
/// floor and a wall of a room) are one contact, unless a later one is hit harder than those that
/// the UAV already touches.
class ContactLog {
 public:
  /// Too short for a UAV to fall, bounce or accelerate to a speed that would hide a crash.
  static constexpr Duration kSameContact = std::chrono::milliseconds(100);

  ContactLog();

  /// All touches of a step boundary, before those of the next one. Allocates only if there are
  /// many.
  void add(const Touch& touch);
  /// The contacts that began since the last call, in the order of time. Call between two steps.
  std::vector<Contact> take();
  void reset();

 private:
  struct Touched {
    Touch first;  ///< with the greatest speed of its instant
    SimTime last;
  };

  void begin(const Touch& touch);

  std::vector<Touched> touched_;
  std::vector<Touch> begun_;
};

struct Convex;

/// From a UAV to the nearest of the other collision shapes.
struct Clearance {
  double distance_m = 0.0;  ///< 0: it touches, or is inside
  std::string_view to;      ///< name of the model or UAV; refers into the world
};

/// The vertices of a mesh, scaled, in its own frame.
using MeshVertices = std::function<std::vector<uav::Vec3>(const MeshGeometry& mesh)>;

/// Measures distances between the collision shapes of a world: exact up to rounding; a mesh is its
/// convex hull, a plane is solid below. It has no part in the simulation, so that every back end
/// can use it.
///
/// Not thread-safe.
class ClearanceMeter {
 public:
  /// `world` must outlive it. Without `vertices`, nothing is measured in worlds where a mesh
  /// collides.
  ClearanceMeter(const World& world, const MeshVertices& vertices);
  ~ClearanceMeter();

  /// With the moving bodies at `X_WB`. None: the UAV has no collision shape, nothing else has one,
  /// or a mesh is not known. @pre one pose for each of `moving_bodies(world)`.
  std::optional<Clearance> measure(std::size_t uav, std::span<const uav::Pose> X_WB) const;

  /// What a UAV starts inside of, touching or below; standing on it is fine. Empty: nothing.
  std::string_view obstacle_of_start(std::size_t uav) const;
  /// Warns of each UAV that starts inside or touching something (standing on it is fine), below the
  /// floor, or far from every anchor.
  void warn_of_starts(const WarningSink& warn) const;
  /// Warns once of each UAV that is below all that the world has, as beside the edge of its floor.
  void warn_of_falls(std::span<const uav::Pose> X_WB, const WarningSink& warn);

 private:
  struct Shape;
  struct Ball;
  struct Nearest {
    double distance_m = std::numeric_limits<double>::infinity();
    std::size_t shape = 0;
    auto operator<=>(const Nearest&) const = default;
  };

  void add(const Link& link, const uav::Pose& X_BL, std::optional<std::size_t> body,
           std::string_view owner, const MeshVertices& vertices);
  std::span<const uav::Vec3> vertices_of(const MeshGeometry& mesh, const MeshVertices& vertices);
  void find_nearest(const Shape& own, std::span<const uav::Pose> X_WB, std::size_t first,
                    Nearest& nearest) const;
  double lowest_m() const;
  static double distance_between(const Convex& here, const Ball& around, const Shape& other,
                                 std::span<const uav::Pose> X_WB, double enough_m);
  std::string_view shape_overhead(const uav::Vec3& p_W) const;

  const World& world_;
  std::map<MeshKey, std::vector<uav::Vec3>> vertices_;  ///< Shapes refer to them.
  std::vector<Shape> shapes_;
  std::vector<Ball> balls_;                          ///< of each shape
  std::vector<std::vector<std::size_t>> of_bodies_;  ///< their shapes
  /// Of each body, the shape that was the nearest when it was last measured; the result does not
  /// depend on it.
  mutable std::vector<std::size_t> last_nearest_;
  std::vector<uav::Pose> starts_;
  double lowest_m_ = 0.0;  ///< of all fixed shapes and the starts of UAVs
  std::vector<bool> has_fallen_;
  bool is_complete_ = true;
};

}  // namespace tether::sim
