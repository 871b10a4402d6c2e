#pragma once

#include <utility>
#include <vector>

#include <gazebo/rendering/RenderTypes.hh>
#include <ignition/math/Pose3.hh>

#include <tether/sim_protocol/messages.h>

namespace Ogre {
class Node;
}

namespace tether::gazebo_plugin {

/// While it exists, the scene's bodies are at the poses of a view, and the hidden one is removed.
class PlacedBodies {
 public:
  PlacedBodies(const std::vector<::gazebo::rendering::VisualPtr>& bodies,
               const sim::protocol::Render& view);
  ~PlacedBodies();
  PlacedBodies(const PlacedBodies&) = delete;
  PlacedBodies& operator=(const PlacedBodies&) = delete;

 private:
  std::vector<std::pair<::gazebo::rendering::VisualPtr, ignition::math::Pose3d>> before_;
  Ogre::Node* hidden_ = nullptr;
  Ogre::Node* parent_of_hidden_ = nullptr;
};

}  // namespace tether::gazebo_plugin
