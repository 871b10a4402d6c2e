// Draws views with MuJoCo's renderer in an EGL context. Each view sets the camera's frustum, adds
// the visuals that it may contain to the engine's scene, renders off screen, and reads the pixels
// back.

#include "renderer.h"

#include "conversions.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include <GL/gl.h>
#include <GL/glext.h>

#include <tether/base/error.h>

namespace tether::sim {
namespace {

using uav::Pose;
using uav::Vec3;

constexpr int kFontScale = 50;
constexpr float kOpaque = 0.995F;  // the engine's bound

// The image's edges at distance 1, in optical axes. A pixel's coordinates are those of its centre,
// so the image begins half a pixel before pixel 0.
struct Frustum {
  double left, right, top, bottom;

  explicit Frustum(const uav::CameraModel& c)
      : left(-(c.cx_px + 0.5) / c.fx_px),
        right((c.width_px - 0.5 - c.cx_px) / c.fx_px),
        top(-(c.cy_px + 0.5) / c.fy_px),
        bottom((c.height_px - 0.5 - c.cy_px) / c.fy_px) {}

  // Whether a sphere may be seen; `x` right, `y` down, `z` ahead.
  bool may_contain(double x, double y, double z, double radius) const {
    return is_inside(x - left * z, left, radius) && is_inside(right * z - x, right, radius) &&
           is_inside(y - top * z, top, radius) && is_inside(bottom * z - y, bottom, radius);
  }

 private:
  static bool is_inside(double distance, double slope, double radius) {
    return distance > -radius * std::sqrt(1.0 + slope * slope);
  }
};

void draw(const TriangleMesh& mesh) {
  glBegin(GL_TRIANGLES);
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t i : triangle) {
      const TriangleMesh::Vertex& vertex = mesh.vertices[i];
      glTexCoord2fv(vertex.uv.data());
      glNormal3fv(vertex.normal.data());
      glVertex3fv(vertex.position.data());
    }
  }
  glEnd();
}

// A rotation matrix, row by row.
void rotation_matrix(const uav::Quat& q, float* out) {
  const Vec3 x = rotate(q, {1.0, 0.0, 0.0});
  const Vec3 y = rotate(q, {0.0, 1.0, 0.0});
  const Vec3 z = rotate(q, {0.0, 0.0, 1.0});
  copy_to(Vec3{x.x, y.x, z.x}, out);
  copy_to(Vec3{x.y, y.y, z.y}, out + 3);
  copy_to(Vec3{x.z, y.z, z.z}, out + 6);
}

// The sky's colour, after all other textures, as a pixel of RawImage.
std::uint32_t sky_colour(const mjModel& model) {
  const mjtByte* rgb = model.tex_rgb + model.tex_adr[model.ntex - 1];
  const std::array<std::uint8_t, 4> rgba{rgb[0], rgb[1], rgb[2], 255};
  return std::bit_cast<std::uint32_t>(rgba);
}

EngineScenePtr make_engine_scene(std::size_t max_geoms) {
  EngineScenePtr scene(new mjvScene{});
  mjv_defaultScene(scene.get());
  mjv_makeScene(nullptr, scene.get(), static_cast<int>(max_geoms));
  return scene;
}

}  // namespace

Renderer::Renderer(Scene scene, int max_width_px, int max_height_px)
    : scene_(std::move(scene)),
      model_(make_scene_model(scene_, max_width_px, max_height_px)),
      engine_scene_(make_engine_scene(scene_.items.size() + 1)),
      background_(sky_colour(*model_)) {
  const EglBinding binding(egl_);
  mjr_defaultContext(&context_);
  mjr_makeContext(model_.get(), &context_, kFontScale);
  mjr_setBuffer(mjFB_OFFSCREEN, &context_);
  if (context_.currentBuffer != mjFB_OFFSCREEN) {
    throw Error(ErrorCode::kSetup, "OpenGL (" + name() + ") cannot draw into memory");
  }
  fill_mesh_lists();
  // Small things tend to stand before large ones, and what is hidden costs little.
  std::stable_sort(
      scene_.items.begin(), scene_.items.end(),
      [](const SceneItem& a, const SceneItem& b) { return a.bounds.radius_m < b.bounds.radius_m; });
  std::copy(scene_.lights.begin(), scene_.lights.end(), engine_scene_->lights);
  engine_scene_->nlight = static_cast<int>(scene_.lights.size());
  engine_scene_->flags[mjRND_SHADOW] = scene_.shadows ? 1 : 0;
  engine_scene_->flags[mjRND_REFLECTION] = 0;
  engine_scene_->flags[mjRND_HAZE] = 0;
}

Renderer::~Renderer() {
  const EglBinding binding(egl_);
  mjr_freeContext(&context_);
}

void Renderer::fill_mesh_lists() {
  for (std::size_t i = 0; i < scene_.meshes.size(); ++i) {
    glNewList(context_.baseMesh + static_cast<GLuint>(mesh_list(i)), GL_COMPILE);
    draw(scene_.meshes[i]);
    glEndList();
    scene_.meshes[i] = {};
  }
}

void Renderer::render(const View& view, std::span<std::uint8_t> rgb) {
  const EglBinding binding(egl_);
  image_.width_px = view.camera.width_px;
  image_.height_px = view.camera.height_px;
  near_m_ = view.near_m;
  far_m_ = view.far_m;
  set_camera(view);
  place_items(view);
  mjr_render({0, 0, image_.width_px, image_.height_px}, engine_scene_.get(), &context_);
  read_back();
  convert_to_rgb(image_, background_, rgb);
}

void Renderer::set_camera(const View& view) {
  const Frustum frustum(view.camera);
  mjvGLCamera camera{};
  copy_to(view.X_WS.p, camera.pos);
  copy_to(rotate(view.X_WS.q, {1.0, 0.0, 0.0}), camera.forward);
  copy_to(rotate(view.X_WS.q, {0.0, 0.0, 1.0}), camera.up);
  camera.frustum_center = static_cast<float>(0.5 * (frustum.left + frustum.right) * view.near_m);
  camera.frustum_top = static_cast<float>(-frustum.top * view.near_m);
  camera.frustum_bottom = static_cast<float>(-frustum.bottom * view.near_m);
  camera.frustum_near = static_cast<float>(view.near_m);
  camera.frustum_far = static_cast<float>(view.far_m);
  engine_scene_->camera[0] = camera;
  engine_scene_->camera[1] = camera;
}

// Only what may be in the picture, unless its shadow may be. The engine clears to 0, and what is
// left so is the background: its sky takes a pass over the whole picture, and is drawn only for
// transparent things to have it behind them.
void Renderer::place_items(const View& view) {
  const Frustum frustum(view.camera);
  const Pose X_SW = inverse(view.X_WS);
  int count = 0;
  bool any_transparent = false;
  for (const SceneItem& item : scene_.items) {
    if (item.body && item.body == view.hidden) continue;
    const Pose X_WV = item.body ? view.X_WB[*item.body] * item.X_BV : item.X_BV;
    const Vec3 p_S = transform(X_SW, transform(X_WV, item.bounds.centre));
    if (!scene_.shadows && !frustum.may_contain(-p_S.y, -p_S.z, p_S.x, item.bounds.radius_m)) {
      continue;
    }
    any_transparent = any_transparent || item.geom.rgba[3] < kOpaque;
    mjvGeom& geom = engine_scene_->geoms[count++];
    geom = item.geom;
    copy_to(X_WV.p, geom.pos);
    rotation_matrix(X_WV.q, geom.mat);
  }
  engine_scene_->ngeom = count;
  engine_scene_->flags[mjRND_SKYBOX] = any_transparent ? 1 : 0;
}

// The multisampled picture is resolved first, where there are several samples.
void Renderer::read_back() {
  const int width = image_.width_px;
  const int height = image_.height_px;
  image_.rgba.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  glBindFramebuffer(GL_READ_FRAMEBUFFER, context_.offFBO);
  if (context_.offSamples > 0) {
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, context_.offFBO_r);
    glReadBuffer(GL_COLOR_ATTACHMENT0);
    glDrawBuffer(GL_COLOR_ATTACHMENT0);
    glBlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, context_.offFBO_r);
  }
  glReadBuffer(GL_COLOR_ATTACHMENT0);
  glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, image_.rgba.data());
  mjr_restoreBuffer(&context_);
}

// The buffer holds the share of the way from 1/near to 1/far.
double Renderer::nearest_depth_m() {
  const EglBinding binding(egl_);
  depth_.resize(image_.rgba.size());
  mjr_readPixels(nullptr, depth_.data(), {0, 0, image_.width_px, image_.height_px}, &context_);
  const double share = *std::min_element(depth_.begin(), depth_.end());
  return 1.0 / ((1.0 - share) / near_m_ + share / far_m_);
}

}  // namespace tether::sim
