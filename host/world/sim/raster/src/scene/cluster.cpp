#include "scene/prepared_scene.h"

#include <algorithm>
#include <iterator>

namespace tether::raster {
namespace {

uav::Vec3 point(const Mesh::Vertex& v) {
  return {v.position[0], v.position[1], v.position[2]};
}

Box box_around(const PreparedScene& scene, std::size_t first, std::size_t count) {
  Box box = Box::none();
  for (std::size_t i = first; i < first + count; ++i) {
    const uav::Vec3 p{scene.x[i], scene.y[i], scene.z[i]};
    box.include({p, p});
  }
  return box;
}

// A vertex twice, or three on one line exactly.
bool has_area(const Mesh& mesh, const std::array<std::uint32_t, 3>& t) {
  const uav::Vec3 a = point(mesh.vertices[t[0]]);
  const uav::Vec3 n = cross(point(mesh.vertices[t[1]]) - a, point(mesh.vertices[t[2]]) - a);
  return n.x != 0.0 || n.y != 0.0 || n.z != 0.0;
}

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

// All first corners, then all second ones, then all third ones; the last is repeated, because whole
// vectors are read.
void add_corners(const Mesh& mesh, const Triangles& triangles, std::size_t first,
                 PreparedScene& scene) {
  Cluster& cluster = scene.clusters.back();
  for (std::size_t corner = 0; corner < 3; ++corner) {
    for (std::size_t i = 0; i < cluster.stride; ++i) {
      const std::size_t triangle = first + std::min<std::size_t>(i, cluster.triangles - 1);
      const auto& p = mesh.vertices[triangles[triangle][corner]].position;
      scene.x.push_back(p[0]);
      scene.y.push_back(p[1]);
      scene.z.push_back(p[2]);
    }
  }
}

}  // namespace

PreparedMesh add_mesh(const Mesh& mesh, PreparedScene& scene) {
  PreparedMesh prepared;
  prepared.first_cluster = static_cast<std::uint32_t>(scene.clusters.size());
  prepared.first_look = static_cast<std::uint32_t>(scene.looks.size());
  for (const Mesh::Vertex& v : mesh.vertices) scene.looks.push_back({v.normal, v.uv});
  Triangles kept;
  std::copy_if(mesh.triangles.begin(), mesh.triangles.end(), std::back_inserter(kept),
               [&](const auto& corners) { return has_area(mesh, corners); });
  prepared.triangles = static_cast<std::uint32_t>(kept.size());
  const std::size_t first_corner = scene.x.size();
  for (std::size_t i = 0; i < kept.size(); i += Cluster::kMaxTriangles) {
    Cluster& cluster = scene.clusters.emplace_back();
    cluster.first_corner = static_cast<std::uint32_t>(scene.x.size());
    cluster.first_triangle = static_cast<std::uint32_t>(scene.triangles.size() + i);
    cluster.triangles =
        static_cast<std::uint32_t>(std::min(Cluster::kMaxTriangles, kept.size() - i));
    cluster.stride = (cluster.triangles + kMaxLanes - 1) / kMaxLanes * kMaxLanes;
    add_corners(mesh, kept, i, scene);
    cluster.bounds =
        box_around(scene, cluster.first_corner, std::size_t{3} * cluster.stride).sphere();
  }
  scene.triangles.insert(scene.triangles.end(), kept.begin(), kept.end());
  prepared.clusters = static_cast<std::uint32_t>(scene.clusters.size()) - prepared.first_cluster;
  if (!kept.empty()) {
    prepared.box = box_around(scene, first_corner, scene.x.size() - first_corner);
    prepared.bounds = prepared.box.sphere();
  }
  return prepared;
}

}  // namespace tether::raster
