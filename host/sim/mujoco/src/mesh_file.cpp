#include "mesh_file.h"

#include "conversions.h"

#include <cmath>
#include <set>

#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <tether/base/error.h>

namespace tether::sim {
namespace {

using uav::Vec3;

// Collects the triangles of an Assimp scene.
class MeshCollector {
 public:
  MeshCollector(const aiScene& scene, const MeshGeometry& geometry, const TextureScale& texture)
      : scene_(scene), geometry_(geometry), texture_(texture) {}

  void visit(const aiNode& node, const aiMatrix4x4& parent, bool wanted) {
    const aiMatrix4x4 transform = parent * node.mTransformation;
    wanted = wanted || is_named(node.mName);
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
      const aiMesh& mesh = *scene_.mMeshes[node.mMeshes[i]];
      if (wanted || is_named(mesh.mName)) add(mesh, transform);
    }
    for (unsigned i = 0; i < node.mNumChildren; ++i) visit(*node.mChildren[i], transform, wanted);
  }

  raster::Mesh take() { return std::move(out_); }
  std::size_t materials() const { return materials_.size(); }

 private:
  bool is_named(const aiString& name) const {
    return geometry_.submesh.empty() || geometry_.submesh == name.C_Str();
  }

  void add(const aiMesh& mesh, const aiMatrix4x4& transform) {
    materials_.insert(mesh.mMaterialIndex);
    const std::size_t first = out_.vertices.size();
    const Vec3& s = geometry_.scale;
    const bool mirrored = transform.Determinant() * static_cast<float>(s.x * s.y * s.z) < 0.0F;
    aiMatrix3x3 normal_map(transform);
    normal_map.Inverse().Transpose();
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
      const aiVector3D p = transform * mesh.mVertices[i];
      const aiVector3D n = normal_map * mesh.mNormals[i];
      out_.vertices.push_back(vertex({p.x * s.x, p.y * s.y, p.z * s.z},
                                     {n.x / s.x, n.y / s.y, n.z / s.z}, texture_at(mesh, i)));
    }
    for (unsigned i = 0; i < mesh.mNumFaces; ++i) add_face(mesh.mFaces[i], first, mirrored);
  }

  static const aiVector3D* texture_at(const aiMesh& mesh, unsigned i) {
    return mesh.HasTextureCoords(0) ? &mesh.mTextureCoords[0][i] : nullptr;
  }

  raster::Mesh::Vertex vertex(const Vec3& p, const Vec3& n, const aiVector3D* uv) const {
    raster::Mesh::Vertex v;
    copy_to(p, v.position.data());
    const double length = norm(n);
    copy_to(length > 0.0 ? (1.0 / length) * n : Vec3{0.0, 0.0, 1.0}, v.normal.data());
    v.uv = uv ? std::array<float, 2>{uv->x, uv->y} : projected(p, n);
    return v;
  }

  // A box's mapping: seen along the axis that the surface faces most.
  std::array<float, 2> projected(const Vec3& p, const Vec3& n) const {
    const Vec3 a{std::abs(n.x), std::abs(n.y), std::abs(n.z)};
    double u = p.x;
    double v = -p.z;
    if (a.z >= a.x && a.z >= a.y) v = -p.y;
    if (a.x > a.y && a.x > a.z) u = p.y;
    return {static_cast<float>(u * texture_.repeat_x_per_m),
            static_cast<float>(v * texture_.repeat_y_per_m)};
  }

  void add_face(const aiFace& face, std::size_t first, bool mirrored) {
    if (face.mNumIndices != 3) return;  // points and lines
    const auto base = static_cast<std::uint32_t>(first);
    std::array<std::uint32_t, 3> t{base + face.mIndices[0], base + face.mIndices[1],
                                   base + face.mIndices[2]};
    if (mirrored) std::swap(t[1], t[2]);
    out_.triangles.push_back(t);
  }

  const aiScene& scene_;
  const MeshGeometry& geometry_;
  TextureScale texture_;
  raster::Mesh out_;
  std::set<unsigned> materials_;
};

constexpr unsigned kSteps = aiProcess_Triangulate | aiProcess_GenSmoothNormals |
                            aiProcess_JoinIdenticalVertices | aiProcess_FlipUVs;

}  // namespace

raster::Mesh load_mesh(const MeshGeometry& mesh, const TextureScale& scale,
                       const WarningSink& warn) {
  Assimp::Importer importer;
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  const aiScene* scene = importer.ReadFile(mesh.file.string(), kSteps);
  if (!scene || !scene->mRootNode) {
    throw Error(ErrorCode::kBadFile, {mesh.file.string(), 0},
                std::string("cannot be read as a mesh: ") + importer.GetErrorString());
  }
  MeshCollector collector(*scene, mesh, scale);
  collector.visit(*scene->mRootNode, aiMatrix4x4(), false);
  if (collector.materials() > 1) {
    warn({Consequence::kLooksDifferent,
          {mesh.file.string()},
          "mesh",
          "has several materials, which are not used; the visual's material is"});
  }
  raster::Mesh out = collector.take();
  const auto fail = [&](const char* what) {
    throw Error(ErrorCode::kBadFile, FileLocation{mesh.file.string()}, what);
  };
  if (out.triangles.size() > raster::kMaxTriangles) fail("has more than 10,000,000 triangles");
  for (const raster::Mesh::Vertex& v : out.vertices) {
    for (const float number : {v.position[0], v.position[1], v.position[2], v.uv[0], v.uv[1]}) {
      if (!(std::abs(number) <= raster::kMaxCoordinate_m)) {
        fail("has a vertex that is not finite, or farther than 1,000 km from the origin");
      }
    }
  }
  if (out.triangles.empty()) {
    throw Error(ErrorCode::kBadFile, {mesh.file.string(), 0},
                mesh.submesh.empty() ? "has no triangle" : "has no submesh '" + mesh.submesh + "'")
        .about(mesh.submesh);
  }
  return out;
}

}  // namespace tether::sim
