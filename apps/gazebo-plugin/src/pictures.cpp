#include "pictures.h"

#include "conversions.h"
#include "placed_bodies.h"

#include <algorithm>

#include <GL/gl.h>
#include <gazebo/rendering/RTShaderSystem.hh>
#include <gazebo/rendering/ogre_gazebo.h>
#include <gazebo/rendering/rendering.hh>

namespace tether::gazebo_plugin {
namespace {

using sim::protocol::Picture;
using sim::protocol::Render;

constexpr const char* kGroup = "General";

Ogre::Vector3 to_ogre(const uav::Vec3& v) {
  return Ogre::Vector3(static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z));
}

// Reads how near the nearest thing is, while what was drawn into is still bound.
class DepthReader : public Ogre::RenderTargetListener {
 public:
  DepthReader(int width_px, int height_px)
      : width_px_(width_px),
        height_px_(height_px),
        depth_(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px), 1.0F) {}

  void postViewportUpdate(const Ogre::RenderTargetViewportEvent&) override {
    glReadPixels(0, 0, width_px_, height_px_, GL_DEPTH_COMPONENT, GL_FLOAT, depth_.data());
  }

  // The buffer holds the share of the way from 1/near to 1/far.
  double nearest_m(double near_m, double far_m) const {
    const double share = *std::min_element(depth_.begin(), depth_.end());
    return 1.0 / ((1.0 - share) / near_m + share / far_m);
  }

 private:
  int width_px_;
  int height_px_;
  std::vector<float> depth_;
};

std::vector<::gazebo::rendering::VisualPtr> find_visuals(const ::gazebo::rendering::ScenePtr& scene,
                                                         const std::vector<std::string>& names) {
  std::vector<::gazebo::rendering::VisualPtr> visuals;
  for (const std::string& name : names) visuals.push_back(scene->GetVisual(name));
  return visuals;
}

}  // namespace

Pictures::Pictures(::gazebo::rendering::ScenePtr scene,
                   const std::vector<std::string>& body_visuals)
    : scene_(std::move(scene)),
      bodies_(find_visuals(scene_, body_visuals)),
      camera_(scene_->OgreSceneManager()->createCamera("tether")) {}

Pictures::Canvas& Pictures::canvas(int width_px, int height_px) {
  Canvas& canvas = canvases_[{width_px, height_px}];
  if (canvas.texture) return canvas;
  const std::string name = "tether_" + std::to_string(width_px) + "x" + std::to_string(height_px);
  const Ogre::TexturePtr texture = Ogre::TextureManager::getSingleton().createManual(
      name, kGroup, Ogre::TEX_TYPE_2D, static_cast<unsigned>(width_px),
      static_cast<unsigned>(height_px), 0, Ogre::PF_BYTE_RGB, Ogre::TU_RENDERTARGET);
  canvas.texture = texture->getBuffer()->getRenderTarget();
  canvas.texture->setAutoUpdated(false);
  canvas.viewport = canvas.texture->addViewport(camera_);
  canvas.viewport->setOverlaysEnabled(false);
  canvas.viewport->setVisibilityMask(GZ_VISIBILITY_ALL &
                                     ~(GZ_VISIBILITY_GUI | GZ_VISIBILITY_SELECTABLE));
  ::gazebo::rendering::RTShaderSystem::AttachViewport(canvas.viewport, scene_);
  return canvas;
}

// A pixel's coordinates are those of its centre, so the picture begins half a pixel before pixel 0.
void Pictures::aim(const Render& view) {
  const uav::CameraModel& c = view.camera;
  const double scale = view.near_m / c.fx_px;
  const auto at = [&](double px, double centre_px) {
    return static_cast<float>((px - centre_px) * scale);
  };
  camera_->setNearClipDistance(static_cast<float>(view.near_m));
  camera_->setFarClipDistance(static_cast<float>(view.far_m));
  camera_->setAspectRatio(static_cast<float>(c.width_px) / static_cast<float>(c.height_px));
  camera_->setFrustumExtents(at(-0.5, c.cx_px), at(c.width_px - 0.5, c.cx_px), -at(-0.5, c.cy_px),
                             -at(c.height_px - 0.5, c.cy_px));
  camera_->setPosition(to_ogre(view.X_WS.p));
  // Ogre's cameras look along −z, with x to the right.
  camera_->setOrientation(Ogre::Quaternion(to_ogre(rotate(view.X_WS.q, {0.0, -1.0, 0.0})),
                                           to_ogre(rotate(view.X_WS.q, {0.0, 0.0, 1.0})),
                                           to_ogre(rotate(view.X_WS.q, {-1.0, 0.0, 0.0}))));
}

Picture Pictures::draw(const Render& view) {
  const int width = view.camera.width_px;
  const int height = view.camera.height_px;
  const PlacedBodies placed(bodies_, view);
  Canvas& canvas = this->canvas(width, height);
  const auto background = scene_->BackgroundColor();
  canvas.viewport->setBackgroundColour(
      Ogre::ColourValue(background.R(), background.G(), background.B(), background.A()));
  aim(view);
  Picture picture{width, height, {}, 0.0, {}};
  DepthReader depth(view.with_depth ? width : 0, view.with_depth ? height : 0);
  if (view.with_depth) canvas.texture->addListener(&depth);
  canvas.texture->update();
  if (view.with_depth) {
    canvas.texture->removeListener(&depth);
    picture.nearest_depth_m = depth.nearest_m(view.near_m, view.far_m);
  }
  picture.rgb.resize(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  const Ogre::PixelBox pixels(static_cast<unsigned>(width), static_cast<unsigned>(height), 1,
                              Ogre::PF_BYTE_RGB, picture.rgb.data());
  static_cast<Ogre::RenderTarget*>(canvas.texture)->copyContentsToMemory(pixels);
  picture.renderer =
      Ogre::Root::getSingleton().getRenderSystem()->getCapabilities()->getDeviceName();
  return picture;
}

}  // namespace tether::gazebo_plugin
