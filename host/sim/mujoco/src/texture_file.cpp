#include "texture_file.h"

#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>

#include <turbojpeg.h>

#include <tether/base/error.h>

namespace tether::sim {
namespace {

constexpr int kMaxEdge_px = 16384;

std::string read_file(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  if (!in || bytes.empty()) {
    require_a_handle_for(path.string());
    throw Error(ErrorCode::kBadFile, {path.string(), 0}, "cannot be read");
  }
  return bytes;
}

/// Width and height as 32-bit integers, then RGB bytes.
std::string decode_jpeg(const std::filesystem::path& file, const std::string& jpeg) {
  const std::unique_ptr<void, int (*)(tjhandle)> decoder(tjInitDecompress(), tjDestroy);
  const auto* bytes = reinterpret_cast<const unsigned char*>(jpeg.data());
  std::int32_t size_px[2] = {};
  int chroma = 0, space = 0;
  const auto refuse = [&](const std::string& reason) {
    throw Error(ErrorCode::kBadFile, {file.string(), 0}, "cannot be read as a texture: " + reason);
  };
  if (tjDecompressHeader3(decoder.get(), bytes, jpeg.size(), &size_px[0], &size_px[1], &chroma,
                          &space) != 0)
    refuse(tjGetErrorStr2(decoder.get()));
  if (size_px[0] < 1 || size_px[1] < 1) refuse("it has no picture");
  if (size_px[0] > kMaxEdge_px || size_px[1] > kMaxEdge_px)
    refuse("it has more than " + std::to_string(kMaxEdge_px) + " pixels an edge");
  std::string texture(sizeof size_px + std::size_t{3} * static_cast<std::size_t>(size_px[0]) *
                                           static_cast<std::size_t>(size_px[1]),
                      '\0');
  std::memcpy(texture.data(), size_px, sizeof size_px);
  auto* pixels = reinterpret_cast<unsigned char*>(texture.data() + sizeof size_px);
  // A warning, such as one of a truncated file, still fills the image.
  if (tjDecompress2(decoder.get(), bytes, jpeg.size(), pixels, size_px[0], 0, size_px[1], TJPF_RGB,
                    0) != 0 &&
      tjGetErrorCode(decoder.get()) != TJERR_WARNING)
    refuse(tjGetErrorStr2(decoder.get()));
  return texture;
}

}  // namespace

ModelFile texture_file(const std::string& name, const std::filesystem::path& file) {
  std::string bytes = read_file(file);
  const bool is_jpeg = bytes.starts_with("\xff\xd8");
  return is_jpeg ? ModelFile{name + ".rgb", decode_jpeg(file, bytes)}
                 : ModelFile{name + ".png", std::move(bytes)};
}

}  // namespace tether::sim
