#pragma once

#include <utility>
#include <vector>

#include <gazebo/ode/ode.h>

namespace tether::gazebo_plugin {

/// The order in which ODE looks at shapes, and so at contacts. It changes as things move; a world
/// that is reset must begin with the same one each time.
class SpaceOrder {
 public:
  SpaceOrder() = default;
  /// As it is now, of that space and those within it.
  explicit SpaceOrder(dSpaceID space) { remember(space); }
  void restore() const;

 private:
  void remember(dSpaceID space);

  std::vector<std::pair<dSpaceID, std::vector<dGeomID>>> spaces_;
};

}  // namespace tether::gazebo_plugin
