#include "placed_bodies.h"

#include "conversions.h"

#include <gazebo/rendering/ogre_gazebo.h>
#include <gazebo/rendering/rendering.hh>

namespace tether::gazebo_plugin {

PlacedBodies::PlacedBodies(const std::vector<::gazebo::rendering::VisualPtr>& bodies,
                           const sim::protocol::Render& view) {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (!bodies[i]) continue;
    before_.emplace_back(bodies[i], bodies[i]->Pose());
    bodies[i]->SetWorldPose(to_gazebo(view.X_WB[i]));
  }
  if (!view.hidden || !bodies[*view.hidden]) return;
  // Removed instead of made invisible, so that its invisible parts stay invisible.
  hidden_ = bodies[*view.hidden]->GetSceneNode();
  parent_of_hidden_ = hidden_->getParent();
  parent_of_hidden_->removeChild(hidden_);
}

PlacedBodies::~PlacedBodies() {
  if (hidden_) parent_of_hidden_->addChild(hidden_);
  for (const auto& [visual, pose] : before_) visual->SetPose(pose);
}

}  // namespace tether::gazebo_plugin
