#include "open_request.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <variant>

#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <tether/base/error.h>
#include <tether/sim/bodies.h>

namespace tether::sim {
namespace {

/// Of everything in the file, even if only a part is drawn.
double mesh_radius_m(const MeshGeometry& g) {
  Assimp::Importer importer;
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  const aiScene* scene = importer.ReadFile(g.file.string(), aiProcess_PreTransformVertices);
  if (scene == nullptr) {
    throw Error(ErrorCode::kBadFile, {g.file.string(), 0},
                std::string("cannot be read as a mesh: ") + importer.GetErrorString());
  }
  double radius_m = 0.0;
  for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
    const aiMesh& mesh = *scene->mMeshes[m];
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
      const aiVector3D& p = mesh.mVertices[i];
      radius_m =
          std::max(radius_m, norm(uav::Vec3{g.scale.x * p.x, g.scale.y * p.y, g.scale.z * p.z}));
    }
  }
  return radius_m;
}

double radius_m(const Geometry& geometry) {
  return std::visit(
      Visitor{
          [](const BoxGeometry& g) { return 0.5 * norm(g.size_m); },
          [](const CylinderGeometry& g) { return std::hypot(g.radius_m, 0.5 * g.length_m); },
          [](const SphereGeometry& g) { return g.radius_m; },
          [](const CapsuleGeometry& g) { return g.radius_m + 0.5 * g.length_m; },
          [](const EllipsoidGeometry& g) {
            return std::max({g.radii_m.x, g.radii_m.y, g.radii_m.z});
          },
          [](const PlaneGeometry& g) { return 0.5 * std::hypot(g.size_x_m, g.size_y_m); },
          [](const MeshGeometry& g) { return mesh_radius_m(g); },
      },
      geometry);
}

double radius_m(const Link& link) {
  double reach_m = 0.0;
  for (const Visual& visual : link.visuals) {
    reach_m = std::max(reach_m, norm(visual.X_LV.p) + radius_m(visual.geometry));
  }
  return reach_m;
}

}  // namespace

std::vector<double> drawn_radii_m(const World& world) {
  std::vector<double> radii_m;
  for (const MovingBody& body : moving_bodies(world)) radii_m.push_back(radius_m(*body.link));
  return radii_m;
}

}  // namespace tether::sim
