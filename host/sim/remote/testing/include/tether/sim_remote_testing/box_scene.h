#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <tether/sim/world.h>
#include <tether/uav/camera_model.h>

namespace tether::sim::testing {

/// The boxes of a world, and what a ray meets of them. Other shapes are not there. A value; const
/// functions are safe from any thread.
class BoxScene {
 public:
  explicit BoxScene(const World& world);

  struct Hit {
    double distance_m;
    uav::Vec3 rgb;
  };
  /// The first collision (or, `seen`, visual) along the unit vector `ray_W`, but for those of one
  /// body, with the moving bodies where `X_WB` says.
  std::optional<Hit> first_hit(const uav::Vec3& origin_W, const uav::Vec3& ray_W,
                               std::span<const uav::Pose> X_WB,
                               std::optional<std::uint32_t> without, bool seen) const;

 private:
  struct Box {
    std::optional<std::size_t> body;  ///< that it moves with
    uav::Pose X;                      ///< in its body; in W without one
    uav::Vec3 half_m;
    uav::Vec3 rgb;
    bool seen;
  };
  void add(const Link& link, std::optional<std::size_t> body, const uav::Pose& X_WL);

  std::vector<Box> boxes_;
};

}  // namespace tether::sim::testing
