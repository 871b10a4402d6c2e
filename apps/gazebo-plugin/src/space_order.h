#pragma once

#include <utility>
#include <vector>

#include <gazebo/ode/ode.h>

namespace tether::gazebo_plugin {

/// The order in which ODE processes shapes, and so contacts. It changes while bodies move; after a
/// reset it must always be the same.
class SpaceOrder {
 public:
  SpaceOrder() = default;
  /// The current order in that space and those within it.
  explicit SpaceOrder(dSpaceID space) { remember(space); }
  void restore() const;

 private:
  void remember(dSpaceID space);

  std::vector<std::pair<dSpaceID, std::vector<dGeomID>>> spaces_;
};

}  // namespace tether::gazebo_plugin
