// Assimp reads a file with the one reader of its type; MeshCollector collects triangles,
// normals and texture coordinates from its scene, with the limits against hostile files.

#include "mesh_file.h"

#include "collada_check.h"
#include "conversions.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numeric>
#include <set>
#include <string>
#include <string_view>

#include <assimp/BaseImporter.h>
#include <assimp/Importer.hpp>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <tether/base/error.h>
#include <tether/os/text_file.h>

namespace tether::sim {
namespace {

using uav::Vec3;

constexpr std::uintmax_t kLargestMesh = std::uintmax_t{1} << 29;  // 10,000,000 triangles of STL
constexpr unsigned kMaxCorners = 1000;  // Assimp's time grows with their square
constexpr std::size_t kMaxHullCorners = 1'000'000;

[[noreturn]] void fail_mesh(const std::filesystem::path& file, const std::string& what) {
  throw Error(ErrorCode::kBadFile, FileLocation{file.string()}, what);
}

// For each vertex, the first one at its place. Assimp's own search for places would take hours for
// a large mesh that lies in a plane.
std::vector<unsigned> places(const aiMesh& mesh) {
  const auto position = [&](unsigned i) {
    const aiVector3D& p = mesh.mVertices[i];
    return std::tuple{p.x, p.y, p.z};
  };
  std::vector<unsigned> order(mesh.mNumVertices);
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(),
            [&](unsigned a, unsigned b) { return position(a) < position(b); });
  std::vector<unsigned> place(mesh.mNumVertices);
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool is_new = i == 0 || position(order[i]) != position(order[i - 1]);
    place[order[i]] = is_new ? order[i] : place[order[i - 1]];
  }
  return place;
}

bool has_direction(const aiVector3D& v) {
  const float length2 = v.SquareLength();
  return length2 > 0.0F && std::isfinite(length2);
}

// The normals of the vertices, if those of the file do not do; else none. Without any in the file,
// each is the mean of those of all triangles at its place; where one has no direction, it is that
// of its own triangles. Their lengths differ.
std::vector<aiVector3D> mended_normals(const aiMesh& mesh) {
  const aiVector3D* const given = mesh.mNormals;
  if (given != nullptr && std::all_of(given, given + mesh.mNumVertices, has_direction)) return {};
  std::vector<unsigned> place(mesh.mNumVertices);
  std::iota(place.begin(), place.end(), 0U);
  if (given == nullptr) place = places(mesh);
  std::vector<aiVector3D> sums(mesh.mNumVertices);
  for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
    const aiFace& face = mesh.mFaces[i];
    if (face.mNumIndices != 3) continue;
    const auto at = [&](unsigned corner) { return mesh.mVertices[face.mIndices[corner]]; };
    const aiVector3D normal = ((at(1) - at(0)) ^ (at(2) - at(0))).NormalizeSafe();
    for (unsigned corner = 0; corner < 3; ++corner) sums[place[face.mIndices[corner]]] += normal;
  }
  std::vector<aiVector3D> normals;
  for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
    normals.push_back(given != nullptr && has_direction(given[i]) ? given[i] : sums[place[i]]);
  }
  return normals;
}

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
    require_finite(mesh);
    const std::vector<aiVector3D> mended = mended_normals(mesh);
    const aiVector3D* const normals = mended.empty() ? mesh.mNormals : mended.data();
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
      const aiVector3D p = transform * mesh.mVertices[i];
      const aiVector3D n = normal_map * normals[i];
      out_.vertices.push_back(vertex({p.x * s.x, p.y * s.y, p.z * s.z},
                                     {n.x / s.x, n.y / s.y, n.z / s.z}, texture_at(mesh, i)));
    }
    for (unsigned i = 0; i < mesh.mNumFaces; ++i) add_face(mesh.mFaces[i], first, mirrored);
    // A file may name a mesh any number of times.
    if (out_.triangles.size() > raster::kMaxTriangles ||
        out_.vertices.size() > 3 * raster::kMaxTriangles) {
      fail_mesh(geometry_.file, "has more than 10,000,000 triangles");
    }
  }

  void require_finite(const aiMesh& mesh) const {
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
      const aiVector3D& p = mesh.mVertices[i];
      if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
        fail_mesh(geometry_.file, "has a vertex that is not finite");
      }
    }
  }

  static bool is_near(float number) { return std::abs(number) <= raster::kMaxCoordinate_m; }

  static const aiVector3D* texture_at(const aiMesh& mesh, unsigned i) {
    return mesh.HasTextureCoords(0) ? &mesh.mTextureCoords[0][i] : nullptr;
  }

  raster::Mesh::Vertex vertex(const Vec3& p, const Vec3& n, const aiVector3D* uv) const {
    raster::Mesh::Vertex v;
    copy_to(p, v.position.data());
    const double length = norm(n);
    const bool is_usable = length > 0.0 && std::isfinite(length);
    copy_to(is_usable ? (1.0 / length) * n : Vec3{0.0, 0.0, 1.0}, v.normal.data());
    v.uv = uv ? std::array<float, 2>{uv->x, uv->y} : projected(p, n);
    if (!std::all_of(v.position.begin(), v.position.end(), is_near)) {
      fail_mesh(geometry_.file,
                "has a vertex that is not finite, or farther than 1,000 km from the origin");
    }
    if (!std::all_of(v.uv.begin(), v.uv.end(), is_near)) {
      fail_mesh(geometry_.file,
                "has a texture coordinate that is not finite, or beyond 1,000,000 repetitions");
    }
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

void check_faces(const aiScene& scene, const std::filesystem::path& file) {
  for (unsigned i = 0; i < scene.mNumMeshes; ++i) {
    const aiMesh& mesh = *scene.mMeshes[i];
    for (unsigned k = 0; k < mesh.mNumFaces; ++k) {
      const aiFace& face = mesh.mFaces[k];
      if (face.mNumIndices > kMaxCorners) fail_mesh(file, "has a face of more than 1000 corners");
      const auto is_vertex = [&](unsigned index) { return index < mesh.mNumVertices; };
      if (!std::all_of(face.mIndices, face.mIndices + face.mNumIndices, is_vertex)) {
        fail_mesh(file, "has a face with a vertex that does not exist");
      }
    }
  }
}

// ".obj", whatever the case of the name.
std::string type_of(const std::filesystem::path& file) {
  std::string type = file.extension().string();
  for (char& c : type) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return type;
}

// Leaves only the reader of a type: Assimp tries all of its fifty where the content is not what
// the name says.
void keep_reader(Assimp::Importer& importer, const std::string& type) {
  const Assimp::BaseImporter* const wanted = importer.GetImporter(type.c_str());
  for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
    std::unique_ptr<Assimp::BaseImporter> reader(importer.GetImporter(i));
    if (reader.get() == wanted) {
      static_cast<void>(reader.release());
    } else {
      importer.UnregisterLoader(reader.get());
    }
  }
}

// Pictures are not used, but Assimp refuses a file in which one has no name. It skips libraries
// that it does not know.
void hide_pictures(std::string& collada) {
  constexpr std::string_view kLibrary = "library_images", kUnknown = "library_hidden";
  static_assert(kLibrary.size() == kUnknown.size());
  for (std::size_t at = 0; (at = collada.find(kLibrary, at)) != std::string::npos;) {
    collada.replace(at, kLibrary.size(), kUnknown);
  }
}

std::unique_ptr<Assimp::Importer> import(const std::filesystem::path& file) {
  std::string bytes = os::read_file(file, kLargestMesh);
  const std::string type = type_of(file);
  if (type == ".dae") {
    check_collada(bytes, file);
    hide_pictures(bytes);
  }
  auto importer = std::make_unique<Assimp::Importer>();
  keep_reader(*importer, type);
  importer->SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  // Submeshes go by the names of nodes, as in Gazebo, not by their ids.
  importer->SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_USE_COLLADA_NAMES, true);
  importer->SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
  // Of these bytes alone: a file could name any other. The importer deletes the object in the end,
  // but would leave it if it got another now; it does not read again.
  importer->SetIOHandler(new Assimp::MemoryIOSystem(
      reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size(), nullptr));
  const std::string name_of_bytes = AI_MEMORYIO_MAGIC_FILENAME + type;
  const aiScene* scene = importer->ReadFile(name_of_bytes, 0);
  if (!scene || !scene->mRootNode) {
    std::string why = importer->GetErrorString();
    if (const std::size_t at = why.find(name_of_bytes); at != std::string::npos) {
      why.replace(at, name_of_bytes.size(), file.filename().string());
    }
    fail_mesh(file, "cannot be read as a mesh: " + why);
  }
  check_faces(*scene, file);
  importer->ApplyPostProcessing(aiProcess_Triangulate | aiProcess_FlipUVs);
  return importer;
}

bool has_area(const raster::Mesh& mesh) {
  return std::ranges::any_of(mesh.triangles, [&](const auto& triangle) {
    const auto at = [&](std::size_t i) {
      const auto& [x, y, z] = mesh.vertices[triangle[i]].position;
      return Vec3{x, y, z};
    };
    return norm(cross(at(1) - at(0), at(2) - at(0))) > 0.0;
  });
}

// Moves the middle of its extent to the origin.
void center(raster::Mesh& mesh) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto place = [axis](const raster::Mesh::Vertex& v) { return v.position[axis]; };
    const auto [least, most] = std::ranges::minmax_element(mesh.vertices, {}, place);
    const float middle = 0.5F * (place(*least) + place(*most));
    for (raster::Mesh::Vertex& v : mesh.vertices) v.position[axis] -= middle;
  }
}

}  // namespace

MeshFiles::MeshFiles() = default;
MeshFiles::~MeshFiles() = default;
MeshFiles::MeshFiles(MeshFiles&&) noexcept = default;
MeshFiles& MeshFiles::operator=(MeshFiles&&) noexcept = default;

const Assimp::Importer& MeshFiles::imported(const std::filesystem::path& file) const {
  std::unique_ptr<Assimp::Importer>& importer = files_[file];
  if (!importer) importer = import(file);
  return *importer;
}

raster::Mesh MeshFiles::load(const MeshGeometry& mesh, const TextureScale& scale,
                             const WarningSink& warn) const {
  const aiScene& scene = *imported(mesh.file).GetScene();
  MeshCollector collector(scene, mesh, scale);
  collector.visit(*scene.mRootNode, aiMatrix4x4(), false);
  if (collector.materials() > 1) {
    warn({Consequence::kLooksDifferent,
          {mesh.file.string()},
          "mesh",
          "has several materials, which are not used; the visual's material is",
          true});
  }
  raster::Mesh out = collector.take();
  if (out.triangles.empty() && !mesh.submesh.empty()) {
    throw Error(ErrorCode::kBadFile, {mesh.file.string(), 0},
                "has no submesh '" + mesh.submesh + "'")
        .about(mesh.submesh);
  }
  if (!has_area(out)) fail_mesh(mesh.file, "has no triangle with an area");
  if (mesh.is_centered) center(out);
  return out;
}

std::vector<Vec3> MeshFiles::corners(const MeshGeometry& mesh) const {
  std::vector<std::array<float, 3>> places;
  for (const raster::Mesh::Vertex& v : load(mesh, {}, [](const Warning&) {}).vertices) {
    places.push_back(v.position);
  }
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  if (places.size() > kMaxHullCorners) {
    fail_mesh(mesh.file, "has more than 1,000,000 vertices, which is too many for a collision");
  }
  std::vector<Vec3> corners;
  for (const auto& [x, y, z] : places) corners.push_back({x, y, z});
  return corners;
}

}  // namespace tether::sim
