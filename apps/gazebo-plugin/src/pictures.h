#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gazebo/rendering/RenderTypes.hh>

#include <tether/sim_protocol/messages.h>

namespace Ogre {
class Camera;
class RenderTexture;
class Viewport;
}  // namespace Ogre

namespace tether::gazebo_plugin {

/// Draws pictures of a scene whose bodies are where a host says. In the main thread only.
class Pictures {
 public:
  /// `body_visuals`: of each body, the visual that moves it.
  Pictures(::gazebo::rendering::ScenePtr scene, const std::vector<std::string>& body_visuals);

  sim::protocol::Picture draw(const sim::protocol::Render& view);

 private:
  /// What pictures of one size are drawn into.
  struct Canvas {
    Ogre::RenderTexture* texture = nullptr;
    Ogre::Viewport* viewport = nullptr;
  };

  Canvas& canvas(int width_px, int height_px);
  void aim(const sim::protocol::Render& view);

  ::gazebo::rendering::ScenePtr scene_;
  std::vector<::gazebo::rendering::VisualPtr> bodies_;
  Ogre::Camera* camera_;
  std::map<std::pair<int, int>, Canvas> canvases_;
};

}  // namespace tether::gazebo_plugin
