#include "meshes/usable_meshes.h"

#include "heightmap.h"

#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <tether/base/error.h>

namespace tether::sim {
namespace {

class UsableMeshes {
 public:
  UsableMeshes(const MeshFiles& meshes, const WarningSink& warn) : meshes_(meshes), warn_(warn) {}

  template <class Part>
  void leave_out(std::vector<Part>& parts, const char* kind) {
    std::erase_if(parts, [&](const Part& part) {
      const auto* mesh = std::get_if<MeshGeometry>(&part.geometry);
      if (mesh == nullptr) return false;
      const std::optional<std::string>& problem = problem_of(*mesh);
      if (problem)
        warn_({Consequence::kMissing, mesh->named_at, fmt::format("{} '{}'", kind, part.name),
               "cannot be used and is left out: " + *problem});
      return problem.has_value();
    });
  }

 private:
  const std::optional<std::string>& problem_of(const MeshGeometry& mesh) {
    const auto [known, is_new] = problems_.try_emplace(key_of(mesh));
    if (!is_new) return known->second;
    try {
      static_cast<void>(meshes_.load(mesh, {}));
    } catch (const Error& error) {
      if (error.code() != ErrorCode::kBadFile) throw;
      known->second = error.what();
    }
    return known->second;
  }

  const MeshFiles& meshes_;
  const WarningSink& warn_;
  std::map<MeshKey, std::optional<std::string>> problems_;
};

// None: not a mesh, or one that cannot be read, which is refused later.
std::span<const std::vector<uav::Vec3>> pieces_of(const Collision& collision,
                                                  const MeshFiles& meshes) try {
  const auto* mesh = std::get_if<MeshGeometry>(&collision.geometry);
  if (mesh == nullptr) return {};
  return meshes.pieces(*mesh).corners;
} catch (const Error& error) {
  if (error.code() != ErrorCode::kBadFile) throw;
  return {};
}

}  // namespace

void leave_out_unusable_meshes(World& world, const MeshFiles& meshes, const WarningSink& warn) {
  if (world.is_strict) return;
  UsableMeshes usable(meshes, warn);
  for (Model& model : world.models) {
    for (Link& link : model.links) {
      usable.leave_out(link.visuals, "visual");
      usable.leave_out(link.collisions, "collision");
    }
  }
}

void split_collisions(World& world, const MeshFiles& meshes) {
  for (Model& model : world.models) {
    for (Link& link : model.links) {
      std::vector<Collision> all;
      for (const Collision& collision : link.collisions) {
        const std::span<const std::vector<uav::Vec3>> pieces = pieces_of(collision, meshes);
        if (pieces.empty()) all.push_back(collision);
        for (std::size_t i = 0; i < pieces.size(); ++i) {
          Collision& piece = all.emplace_back(collision);
          const auto box = is_heightmap(collision.geometry) ? std::nullopt : as_box(pieces[i]);
          if (box) {
            piece.X_LC = piece.X_LC * box->X_MB;
            piece.geometry = BoxGeometry{box->size_m};
          } else if (pieces.size() > 1) {
            std::get<MeshGeometry>(piece.geometry).piece = i;
          }
        }
      }
      link.collisions = std::move(all);
    }
  }
}

}  // namespace tether::sim
