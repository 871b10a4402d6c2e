// Assimp reads a file with the one reader of its type; MeshCollector collects triangles,
// normals and texture coordinates from its scene, with the limits against hostile files.

#include "meshes/mesh_file.h"

#include "conversions.h"
#include "heightmap.h"
#include "meshes/collada_check.h"
#include "meshes/gltf_check.h"
#include "meshes/obj_check.h"
#include "meshes/texture_file.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <map>
#include <new>
#include <numeric>
#include <set>
#include <string>
#include <string_view>

#include <assimp/BaseImporter.h>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <tether/base/error.h>
#include <tether/base/text.h>
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

// Collects the triangles of an Assimp scene, by the number of their material.
class MeshCollector {
 public:
  MeshCollector(const aiScene& scene, const MeshGeometry& geometry, const TextureScale& texture,
                bool paints)
      : scene_(scene), geometry_(geometry), texture_(texture), paints_(paints) {}

  void visit(const aiNode& node, const aiMatrix4x4& parent, bool wanted) {
    const aiMatrix4x4 transform = parent * node.mTransformation;
    wanted = wanted || is_named(node.mName);
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
      const aiMesh& mesh = *scene_.mMeshes[node.mMeshes[i]];
      if (wanted || is_named(mesh.mName)) add(mesh, transform);
    }
    for (unsigned i = 0; i < node.mNumChildren; ++i) visit(*node.mChildren[i], transform, wanted);
  }

  struct Part {
    unsigned material = 0;
    bool is_painted = false;  // by its vertices
    friend auto operator<=>(const Part&, const Part&) = default;
  };
  std::map<Part, raster::Mesh> take() { return std::move(parts_); }

 private:
  bool is_named(const aiString& name) const {
    return geometry_.submesh.empty() || geometry_.submesh == name.C_Str();
  }

  void add(const aiMesh& mesh, const aiMatrix4x4& transform) {
    const bool is_painted = paints_ && has_vertex_colours(scene_, mesh, geometry_.file);
    raster::Mesh& out = parts_[{mesh.mMaterialIndex, is_painted}];
    const std::size_t first = out.vertices.size();
    const std::size_t triangles_before = out.triangles.size();
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
      out.vertices.push_back(vertex({p.x * s.x, p.y * s.y, p.z * s.z},
                                    {n.x / s.x, n.y / s.y, n.z / s.z}, texture_at(mesh, i)));
    }
    for (unsigned i = 0; i < mesh.mNumFaces; ++i) add_face(mesh.mFaces[i], first, mirrored, out);
    if (is_painted) paint(mesh, first, triangles_before, out);
    // A file may name a mesh any number of times.
    triangles_ += out.triangles.size() - triangles_before;
    vertices_ += out.vertices.size() - first;
    if (triangles_ > raster::kMaxTriangles || vertices_ > 3 * raster::kMaxTriangles) {
      fail_mesh(geometry_.file, "has more than 10,000,000 triangles");
    }
  }

  // Gives each triangle vertices of its own, which are where the palette has its colour.
  static void paint(const aiMesh& mesh, std::size_t first, std::size_t first_triangle,
                    raster::Mesh& out) {
    std::vector<raster::Mesh::Vertex> vertices;
    for (std::size_t t = first_triangle; t < out.triangles.size(); ++t) {
      std::array<unsigned, 3> corners{};
      for (std::size_t i = 0; i < 3; ++i)
        corners[i] = static_cast<unsigned>(out.triangles[t][i] - first);
      const auto uv = place_in_palette(mesh, corners);
      for (std::uint32_t& corner : out.triangles[t]) {
        vertices.push_back(out.vertices[corner]);
        vertices.back().uv = uv;
        corner = static_cast<std::uint32_t>(first + vertices.size() - 1);
      }
    }
    out.vertices.resize(first);
    out.vertices.insert(out.vertices.end(), vertices.begin(), vertices.end());
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
    v.uv = uv ? laid(*uv) : projected(p, n);
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

  std::array<float, 2> laid(const aiVector3D& uv) const {
    if (texture_.over == TextureRepeat::kPerMetre) return {uv.x, uv.y};
    return {static_cast<float>(texture_.left()) + uv.x * static_cast<float>(texture_.repeat_x),
            static_cast<float>(texture_.top()) + uv.y * static_cast<float>(texture_.repeat_y)};
  }

  // A box's mapping: seen along the axis that the surface faces most.
  std::array<float, 2> projected(const Vec3& p, const Vec3& n) const {
    const Vec3 a{std::abs(n.x), std::abs(n.y), std::abs(n.z)};
    double u = p.x;
    double v = -p.z;
    if (a.z >= a.x && a.z >= a.y) v = -p.y;
    if (a.x > a.y && a.x > a.z) u = p.y;
    return {static_cast<float>(u * texture_.repeat_x), static_cast<float>(v * texture_.repeat_y)};
  }

  static void add_face(const aiFace& face, std::size_t first, bool mirrored, raster::Mesh& out) {
    if (face.mNumIndices != 3) return;  // points and lines
    const auto base = static_cast<std::uint32_t>(first);
    std::array<std::uint32_t, 3> t{base + face.mIndices[0], base + face.mIndices[1],
                                   base + face.mIndices[2]};
    if (mirrored) std::swap(t[1], t[2]);
    out.triangles.push_back(t);
  }

  const aiScene& scene_;
  const MeshGeometry& geometry_;
  TextureScale texture_;
  bool paints_;
  std::map<Part, raster::Mesh> parts_;
  std::size_t triangles_ = 0;
  std::size_t vertices_ = 0;
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
  return lower_case(file.extension().string());
}

// Leaves only the reader of a type: Assimp tries all of its fifty where the content is not what
// the name says. The last one of a type reads its latest version.
void keep_reader(Assimp::Importer& importer, const std::string& type) {
  const Assimp::BaseImporter* wanted = nullptr;
  for (std::size_t i = 0; i < importer.GetImporterCount(); ++i) {
    std::set<std::string> types;
    importer.GetImporter(i)->GetExtensionList(types);
    if (types.contains(type.substr(1))) wanted = importer.GetImporter(i);
  }
  for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
    std::unique_ptr<Assimp::BaseImporter> reader(importer.GetImporter(i));
    if (reader.get() == wanted) {
      static_cast<void>(reader.release());
    } else {
      importer.UnregisterLoader(reader.get());
    }
  }
}

// The other files that a mesh may be made of, by whatever path it names them.
class CompanionFiles final : public Assimp::IOSystem {
 public:
  explicit CompanionFiles(MeshGeometry mesh) : mesh_(std::move(mesh)) {}

  bool Exists(const char* name) const override { return find_companion(mesh_, name) != nullptr; }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* name, const char*) override {
    const std::filesystem::path* const file = find_companion(mesh_, name);
    if (file == nullptr) return nullptr;
    std::string bytes = os::read_file(*file, kLargestMesh);
    if (type_of(*file) == ".mtl") bytes = clean_library(bytes);
    if (bytes.empty()) return nullptr;
    auto* const copy = new std::uint8_t[bytes.size()];  // the stream deletes it
    std::copy(bytes.begin(), bytes.end(), copy);
    return new Assimp::MemoryIOStream(copy, bytes.size(), true);
  }
  void Close(Assimp::IOStream* stream) override { delete stream; }

  std::uintmax_t bytes() const {
    std::uintmax_t sum = 0;
    std::error_code ignored;
    for (const std::filesystem::path& file : mesh_.companions)
      if (const auto size = std::filesystem::file_size(file, ignored); !ignored) sum += size;
    return sum;
  }

 private:
  MeshGeometry mesh_;
};

// The mesh itself, and its companions. Where a library of materials is missing, Assimp looks for
// one of the mesh's own name, which Assimp's class would answer with the mesh.
class MeshBytes : public Assimp::MemoryIOSystem {
 public:
  using MemoryIOSystem::MemoryIOSystem;
  bool Exists(const char* name) const override {
    return !is_own_library(name) && MemoryIOSystem::Exists(name);
  }
  Assimp::IOStream* Open(const char* name, const char* mode) override {
    return is_own_library(name) ? nullptr : MemoryIOSystem::Open(name, mode);
  }

 private:
  static bool is_own_library(std::string_view name) {
    return name.starts_with(AI_MEMORYIO_MAGIC_FILENAME) && name.ends_with(".mtl");
  }
};

}  // namespace

struct MeshFiles::Imported {
  explicit Imported(const MeshGeometry& mesh) : companions(mesh) {
    if (mesh.made) {
      read(mesh.file, *mesh.made, ".obj");
      return;
    }
    std::string bytes = os::read_file(mesh.file, kLargestMesh);
    std::string type = type_of(mesh.file);
    if (is_heightmap(mesh)) {
      bytes = obj_of_heights(decode_texture(bytes, mesh.file, [](const Warning&) {}));
      type = ".obj";
    }
    read(mesh.file, std::move(bytes), type);
  }

  CompanionFiles companions;
  Assimp::Importer importer;

 private:
  void read(const std::filesystem::path& file, std::string bytes, const std::string& type);
};

void MeshFiles::Imported::read(const std::filesystem::path& file, std::string bytes,
                               const std::string& type) try {
  if (type == ".dae") check_collada(bytes, file);
  if (type == ".obj") check_obj(bytes, file);
  if (type == ".glb" || type == ".gltf") check_gltf(bytes, bytes.size() + companions.bytes(), file);
  keep_reader(importer, type);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  // Submeshes go by the names of nodes, as in Gazebo, not by their ids.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_USE_COLLADA_NAMES, true);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
  // A file could name any other. The importer deletes the object in the end, but would leave it if
  // it got another now; it does not read again.
  importer.SetIOHandler(new MeshBytes(reinterpret_cast<const std::uint8_t*>(bytes.data()),
                                      bytes.size(), &companions));
  const std::string name_of_bytes = AI_MEMORYIO_MAGIC_FILENAME + type;
  const aiScene* scene = importer.ReadFile(name_of_bytes, 0);
  if (!scene || !scene->mRootNode) {
    std::string why = importer.GetErrorString();
    if (const std::size_t at = why.find(name_of_bytes); at != std::string::npos) {
      why.replace(at, name_of_bytes.size(), file.filename().string());
    }
    fail_mesh(file, "cannot be read as a mesh: " + why);
  }
  check_faces(*scene, file);
  importer.ApplyPostProcessing(aiProcess_Triangulate | aiProcess_FlipUVs);
} catch (const Error&) {
  throw;
} catch (const std::bad_alloc&) {
  throw;
} catch (const std::exception& error) {  // of a step of Assimp that catches none itself
  fail_mesh(file, "cannot be read as a mesh: " + std::string(error.what()));
}

namespace {

bool has_area(const raster::Mesh& mesh) {
  return std::ranges::any_of(mesh.triangles, [&](const auto& triangle) {
    const auto at = [&](std::size_t i) {
      const auto& [x, y, z] = mesh.vertices[triangle[i]].position;
      return Vec3{x, y, z};
    };
    return norm(cross(at(1) - at(0), at(2) - at(0))) > 0.0;
  });
}

// Moves the middle of their extent to the origin.
void center(std::map<MeshCollector::Part, raster::Mesh>& parts) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto place = [axis](raster::Mesh::Vertex& v) -> float& { return v.position[axis]; };
    float least = std::numeric_limits<float>::infinity(), most = -least;
    for (auto& [part, mesh] : parts) {
      for (raster::Mesh::Vertex& v : mesh.vertices) {
        least = std::min(least, place(v));
        most = std::max(most, place(v));
      }
    }
    const float middle = 0.5F * (least + most);
    for (auto& [part, mesh] : parts)
      for (raster::Mesh::Vertex& v : mesh.vertices) place(v) -= middle;
  }
}

std::map<MeshCollector::Part, raster::Mesh> collect(const aiScene& scene, const MeshGeometry& mesh,
                                                    const TextureScale& scale, bool paints) {
  MeshCollector collector(scene, mesh, scale, paints);
  collector.visit(*scene.mRootNode, aiMatrix4x4(), false);
  auto parts = collector.take();
  if (parts.empty() && !mesh.submesh.empty()) {
    throw Error(ErrorCode::kBadFile, {mesh.file.string(), 0},
                "has no submesh '" + mesh.submesh + "'")
        .about(mesh.submesh);
  }
  if (std::ranges::none_of(parts, [](const auto& part) { return has_area(part.second); }))
    fail_mesh(mesh.file, "has no triangle with an area");
  if (mesh.is_centered) center(parts);
  return parts;
}

}  // namespace

MeshFiles::MeshFiles() = default;
MeshFiles::~MeshFiles() = default;
MeshFiles::MeshFiles(MeshFiles&&) noexcept = default;
MeshFiles& MeshFiles::operator=(MeshFiles&&) noexcept = default;

const aiScene& MeshFiles::imported(const MeshGeometry& mesh) const {
  std::unique_ptr<Imported>& imported = files_[mesh.file];
  if (!imported) imported = std::make_unique<Imported>(mesh);
  return *imported->importer.GetScene();
}

raster::Mesh MeshFiles::load(const MeshGeometry& mesh, const TextureScale& scale) const {
  raster::Mesh all;
  for (const auto& [part, some] : collect(imported(mesh), mesh, scale, false)) {
    const auto before = static_cast<std::uint32_t>(all.vertices.size());
    all.vertices.insert(all.vertices.end(), some.vertices.begin(), some.vertices.end());
    for (const auto& [a, b, c] : some.triangles)
      all.triangles.push_back({before + a, before + b, before + c});
  }
  return all;
}

std::vector<MeshPart> MeshFiles::parts(const MeshGeometry& mesh, const WarningSink& warn) const {
  const aiScene& scene = imported(mesh);
  std::vector<MeshPart> parts;
  for (auto& [part, triangles] : collect(scene, mesh, {}, true)) {
    MeshPart& out = parts.emplace_back();
    out.mesh = std::move(triangles);
    if (part.material < scene.mNumMaterials)
      out.look = read_look(scene, *scene.mMaterials[part.material], mesh, warn);
    if (part.is_painted) out.look.picture = palette();
    if (out.look.material.is_double_sided) add_inside(out.mesh);
  }
  return parts;
}

const CollisionPieces& MeshFiles::pieces(const MeshGeometry& any) const {
  MeshGeometry mesh = any;
  mesh.piece.reset();
  const auto known = pieces_.find(key_of(mesh));
  if (known != pieces_.end()) return known->second;
  return pieces_.emplace(key_of(mesh), collision_pieces(load(mesh, {}))).first->second;
}

std::vector<Vec3> MeshFiles::corners(const MeshGeometry& mesh) const {
  std::vector<Vec3> corners;
  const std::vector<std::vector<Vec3>>& pieces = this->pieces(mesh).corners;
  for (std::size_t i = 0; i < pieces.size(); ++i)
    if (!mesh.piece || *mesh.piece == i)
      corners.insert(corners.end(), pieces[i].begin(), pieces[i].end());
  if (corners.size() > kMaxHullCorners) {
    fail_mesh(mesh.file, "has more than 1,000,000 vertices, which is too many for a collision");
  }
  return with_volume(distinct(std::move(corners)));
}

}  // namespace tether::sim
