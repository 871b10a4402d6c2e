#pragma once

#include <string>
#include <vector>

#include <gazebo/rendering/RenderTypes.hh>

#include <tether/sim_protocol/messages.h>

namespace Ogre {
class Camera;
class RenderTexture;
class Viewport;
}  // namespace Ogre

namespace tether::gazebo_plugin {

/// Draws pictures of a scene with its bodies at the poses of a request. Main thread only.
class Pictures {
 public:
  /// `body_visuals`: the visual that moves each body. No view exceeds the given size.
  Pictures(::gazebo::rendering::ScenePtr scene, const std::vector<std::string>& body_visuals,
           int max_width_px, int max_height_px);

  sim::protocol::Picture draw(const sim::protocol::Render& view);

 private:
  void make_canvas(int max_width_px, int max_height_px);
  void choose_size(int width_px, int height_px);
  void aim(const sim::protocol::Render& view);
  /// Draws the view of the last `aim`. True: a part of it is transparent.
  bool update(bool transparent_leaves_depth);

  ::gazebo::rendering::ScenePtr scene_;
  std::vector<::gazebo::rendering::VisualPtr> bodies_;
  Ogre::Camera* camera_;
  /// Pictures of all sizes are drawn into its upper left corner.
  Ogre::RenderTexture* texture_ = nullptr;
  Ogre::Viewport* viewport_ = nullptr;
};

}  // namespace tether::gazebo_plugin
