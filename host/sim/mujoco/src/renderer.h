#pragma once

#include "egl_context.h"
#include "image.h"
#include "scene.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <mujoco/mujoco.h>

#include <tether/sim_sensing/view_renderer.h>

namespace tether::sim {

struct EngineSceneDeleter {
  void operator()(mjvScene* scene) const {
    mjv_freeScene(scene);
    delete scene;
  }
};
using EngineScenePtr = std::unique_ptr<mjvScene, EngineSceneDeleter>;

/// Draws a scene headless. One thread at a time, any thread.
///
/// MuJoCo's renderer sets up lights, materials and textures; the triangles are ours, because it has
/// no texture coordinates for primitives and lights each vertex only. Same input, same bytes on one
/// machine: in software whatever the number of threads.
class Renderer final : public ViewRenderer {
 public:
  /// Images of at most this size. @throws Error(kSetup) without OpenGL, Error(kBadFile) for a bad
  /// texture.
  Renderer(Scene scene, int max_width_px, int max_height_px);
  ~Renderer() override;

  void render(const View& view, std::span<std::uint8_t> rgb) override;
  double nearest_depth_m() override;
  /// OpenGL's name of the renderer.
  std::string name() const override { return egl_.renderer_name(); }

 private:
  void fill_mesh_lists();
  void set_camera(const View& view);
  void place_items(const View& view);
  void read_back();

  Scene scene_;
  EglContext egl_;
  ModelPtr model_;
  EngineScenePtr engine_scene_;
  std::uint32_t background_;  ///< a pixel of it
  mjrContext context_{};
  RawImage image_;
  std::vector<float> depth_;
  double near_m_ = 0.0;  ///< of the last image
  double far_m_ = 0.0;
};

}  // namespace tether::sim
