// Draws pictures with OGRE into one texture, in the main thread: places the bodies, aims the
// camera, and reads colours and depth while the texture is bound. Transparent objects need a second
// pass for the depth.

#include "pictures.h"

#include "conversions.h"
#include "placed_bodies.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include <GL/gl.h>
#include <gazebo/rendering/RTShaderSystem.hh>
#include <gazebo/rendering/ogre_gazebo.h>
#include <gazebo/rendering/rendering.hh>

namespace tether::gazebo_plugin {
namespace {

using sim::protocol::Picture;
using sim::protocol::Render;

Ogre::Vector3 to_ogre(const uav::Vec3& v) {
  return Ogre::Vector3(static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z));
}

// Reads the picture in a texture's corner while the texture is bound. The upper rows come first.
class Reader : public Ogre::RenderTargetListener {
 public:
  Reader(Ogre::RenderTexture& texture, const Render& view) : texture_(texture), view_(view) {
    texture_.addListener(this);
  }
  ~Reader() override { texture_.removeListener(this); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  void postViewportUpdate(const Ogre::RenderTargetViewportEvent&) override {
    read_colours();
    if (view_.with_depth) read_depth();
  }

  std::vector<std::uint8_t> take_rgb() { return std::move(rgb_); }
  // The buffer holds the share of the way from 1/near to 1/far.
  double nearest_m() const {
    const double share = *std::min_element(depth_.begin(), depth_.end());
    return 1.0 / ((1.0 - share) / view_.near_m + share / view_.far_m);
  }

 private:
  // OGRE disables reading from its frame buffers.
  void read_colours() {
    constexpr int kOgresAlignment = 4;
    rgb_.resize(3 * pixels());
    glReadBuffer(GL_COLOR_ATTACHMENT0);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    read(GL_RGB, GL_UNSIGNED_BYTE, rgb_.data());
    glPixelStorei(GL_PACK_ALIGNMENT, kOgresAlignment);
    glReadBuffer(GL_NONE);
  }
  void read_depth() {
    depth_.resize(pixels());
    read(GL_DEPTH_COMPONENT, GL_FLOAT, depth_.data());
  }
  void read(GLenum what, GLenum type, void* to) const {
    glReadPixels(0, 0, view_.camera.width_px, view_.camera.height_px, what, type, to);
  }
  std::size_t pixels() const {
    return static_cast<std::size_t>(view_.camera.width_px) *
           static_cast<std::size_t>(view_.camera.height_px);
  }

  Ogre::RenderTexture& texture_;
  const Render& view_;
  std::vector<std::uint8_t> rgb_;
  std::vector<float> depth_;
};

// Detects transparent objects, and can make them write their depth. Not for a picture of colours:
// the depth would hide what is drawn later behind them.
class TransparentThings : public Ogre::RenderObjectListener {
 public:
  TransparentThings(Ogre::SceneManager& manager, bool leave_depth)
      : manager_(manager), leave_depth_(leave_depth) {
    manager_.addRenderObjectListener(this);
  }
  ~TransparentThings() override { manager_.removeRenderObjectListener(this); }
  TransparentThings(const TransparentThings&) = delete;
  TransparentThings& operator=(const TransparentThings&) = delete;

  // Visuals mark their entities; the sky has no mark.
  void notifyRenderSingleObject(Ogre::Renderable* thing, const Ogre::Pass* pass,
                                const Ogre::AutoParamDataSource*, const Ogre::LightList*,
                                bool) override {
    if (!pass->getParent()->isTransparent()) return;
    const auto* part = dynamic_cast<const Ogre::SubEntity*>(thing);
    if (!part || part->getParent()->getUserObjectBindings().getUserAny().isEmpty()) return;
    any_ = true;
    if (leave_depth_)
      Ogre::Root::getSingleton().getRenderSystem()->_setDepthBufferWriteEnabled(true);
  }

  bool any() const { return any_; }

 private:
  Ogre::SceneManager& manager_;
  bool leave_depth_;
  bool any_ = false;
};

std::vector<::gazebo::rendering::VisualPtr> find_visuals(const ::gazebo::rendering::ScenePtr& scene,
                                                         const std::vector<std::string>& names) {
  std::vector<::gazebo::rendering::VisualPtr> visuals;
  for (const std::string& name : names) visuals.push_back(scene->GetVisual(name));
  return visuals;
}

}  // namespace

Pictures::Pictures(::gazebo::rendering::ScenePtr scene,
                   const std::vector<std::string>& body_visuals, int max_width_px,
                   int max_height_px)
    : scene_(std::move(scene)),
      bodies_(find_visuals(scene_, body_visuals)),
      camera_(scene_->OgreSceneManager()->createCamera("tether")) {
  make_canvas(max_width_px, max_height_px);
}

void Pictures::make_canvas(int max_width_px, int max_height_px) {
  const Ogre::TexturePtr texture = Ogre::TextureManager::getSingleton().createManual(
      "tether", Ogre::ResourceGroupManager::DEFAULT_RESOURCE_GROUP_NAME, Ogre::TEX_TYPE_2D,
      static_cast<unsigned>(max_width_px), static_cast<unsigned>(max_height_px), 0,
      Ogre::PF_BYTE_RGB, Ogre::TU_RENDERTARGET);
  texture_ = texture->getBuffer()->getRenderTarget();
  texture_->setAutoUpdated(false);
  viewport_ = texture_->addViewport(camera_);
  viewport_->setOverlaysEnabled(false);
  viewport_->setVisibilityMask(GZ_VISIBILITY_ALL & ~(GZ_VISIBILITY_GUI | GZ_VISIBILITY_SELECTABLE));
  ::gazebo::rendering::RTShaderSystem::AttachViewport(viewport_, scene_);
}

// OGRE takes fractions of the texture's sides and rounds down to pixels.
void Pictures::choose_size(int width_px, int height_px) {
  const auto share = [](int part, unsigned all) {
    return (static_cast<float>(part) + 0.5F) / static_cast<float>(all);
  };
  viewport_->setDimensions(0.0F, 0.0F, share(width_px, texture_->getWidth()),
                           share(height_px, texture_->getHeight()));
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
  // Ogre's cameras point along −z, with x to the right.
  camera_->setOrientation(Ogre::Quaternion(to_ogre(rotate(view.X_WS.q, {0.0, -1.0, 0.0})),
                                           to_ogre(rotate(view.X_WS.q, {0.0, 0.0, 1.0})),
                                           to_ogre(rotate(view.X_WS.q, {-1.0, 0.0, 0.0}))));
}

bool Pictures::update(bool transparent_leaves_depth) {
  const TransparentThings transparent(*scene_->OgreSceneManager(), transparent_leaves_depth);
  texture_->update();
  return transparent.any();
}

Picture Pictures::draw(const Render& view) {
  const PlacedBodies placed(bodies_, view);
  const auto background = scene_->BackgroundColor();
  viewport_->setBackgroundColour(
      Ogre::ColourValue(background.R(), background.G(), background.B(), background.A()));
  choose_size(view.camera.width_px, view.camera.height_px);
  aim(view);
  Reader reader(*texture_, view);
  const bool has_transparent = update(false);
  Picture picture{view.camera.width_px, view.camera.height_px, reader.take_rgb(), 0.0, {}};
  if (view.with_depth && has_transparent) update(true);
  if (view.with_depth) picture.nearest_depth_m = reader.nearest_m();
  picture.renderer =
      Ogre::Root::getSingleton().getRenderSystem()->getCapabilities()->getDeviceName();
  return picture;
}

}  // namespace tether::gazebo_plugin
