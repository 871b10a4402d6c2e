#pragma once

#include <compare>
#include <cstddef>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <tether/sim/world.h>

namespace tether::sim {

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
