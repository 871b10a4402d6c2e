#include "prepared_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tether::raster {
namespace {

constexpr std::uint32_t kNoCluster = std::numeric_limits<std::uint32_t>::max();

uav::Vec3 point(const Mesh::Vertex& v) {
  return {v.position[0], v.position[1], v.position[2]};
}

Sphere sphere_around(const PreparedScene& scene, std::size_t first, std::size_t count) {
  uav::Vec3 low{scene.x[first], scene.y[first], scene.z[first]};
  uav::Vec3 high = low;
  for (std::size_t i = first; i < first + count; ++i) {
    low = {std::min<double>(low.x, scene.x[i]), std::min<double>(low.y, scene.y[i]),
           std::min<double>(low.z, scene.z[i])};
    high = {std::max<double>(high.x, scene.x[i]), std::max<double>(high.y, scene.y[i]),
            std::max<double>(high.z, scene.z[i])};
  }
  return {0.5 * (low + high), 0.5 * norm(high - low)};
}

// Fills clusters with a mesh's triangles in their order, in which neighbours tend to be near.
class ClusterBuilder {
 public:
  ClusterBuilder(const Mesh& mesh, PreparedScene& scene)
      : mesh_(mesh),
        scene_(scene),
        cluster_of_(mesh.vertices.size(), kNoCluster),
        place_of_(mesh.vertices.size(), 0) {}

  void add(const std::array<std::uint32_t, 3>& corners) {
    if (!is_open_ || !has_room_for(corners)) open();
    std::array<std::uint8_t, 3> local{};
    for (std::size_t i = 0; i < 3; ++i) local[i] = place(corners[i]);
    scene_.triangles.push_back(local);
    ++cluster().triangles;
  }

  // Whole vectors are read: the last vertex is repeated.
  void close() {
    if (!is_open_) return;
    cluster().bounds = sphere_around(scene_, cluster().first_vertex, cluster().vertices);
    while (scene_.x.size() % kMaxLanes != 0) {
      append(scene_.x.back(), scene_.y.back(), scene_.z.back(), scene_.looks.back());
    }
    is_open_ = false;
  }

 private:
  Cluster& cluster() { return scene_.clusters.back(); }
  std::uint32_t index() const { return static_cast<std::uint32_t>(scene_.clusters.size() - 1); }

  void open() {
    close();
    scene_.clusters.push_back({static_cast<std::uint32_t>(scene_.x.size()),
                               0,
                               static_cast<std::uint32_t>(scene_.triangles.size()),
                               0,
                               {}});
    is_open_ = true;
  }

  bool has_room_for(const std::array<std::uint32_t, 3>& corners) {
    const auto fresh = std::count_if(corners.begin(), corners.end(),
                                     [&](std::uint32_t v) { return cluster_of_[v] != index(); });
    return cluster().triangles < Cluster::kMaxTriangles &&
           cluster().vertices + static_cast<std::uint32_t>(fresh) <= Cluster::kMaxVertices;
  }

  std::uint8_t place(std::uint32_t vertex) {
    if (cluster_of_[vertex] != index()) {
      cluster_of_[vertex] = index();
      place_of_[vertex] = static_cast<std::uint8_t>(cluster().vertices++);
      const auto& [p, normal, uv] = mesh_.vertices[vertex];
      append(p[0], p[1], p[2], {normal, uv});
    }
    return place_of_[vertex];
  }

  void append(float x, float y, float z, const VertexLook& look) {
    scene_.x.push_back(x);
    scene_.y.push_back(y);
    scene_.z.push_back(z);
    scene_.looks.push_back(look);
  }

  const Mesh& mesh_;
  PreparedScene& scene_;
  std::vector<std::uint32_t> cluster_of_;
  std::vector<std::uint8_t> place_of_;
  bool is_open_ = false;
};

// A vertex twice, or three on one line exactly.
bool has_area(const Mesh& mesh, const std::array<std::uint32_t, 3>& t) {
  const uav::Vec3 a = point(mesh.vertices[t[0]]);
  const uav::Vec3 n = cross(point(mesh.vertices[t[1]]) - a, point(mesh.vertices[t[2]]) - a);
  return n.x != 0.0 || n.y != 0.0 || n.z != 0.0;
}

}  // namespace

PreparedMesh add_mesh(const Mesh& mesh, PreparedScene& scene) {
  PreparedMesh prepared;
  prepared.first_cluster = static_cast<std::uint32_t>(scene.clusters.size());
  ClusterBuilder builder(mesh, scene);
  for (const auto& corners : mesh.triangles) {
    if (!has_area(mesh, corners)) continue;
    builder.add(corners);
    ++prepared.triangles;
  }
  builder.close();
  prepared.clusters = static_cast<std::uint32_t>(scene.clusters.size()) - prepared.first_cluster;
  if (prepared.clusters > 0) {
    const std::size_t first = scene.clusters[prepared.first_cluster].first_vertex;
    prepared.bounds = sphere_around(scene, first, scene.x.size() - first);
  }
  return prepared;
}

}  // namespace tether::raster
