#include "meshes/texture_file.h"

#include <memory>

#include <png.h>
#include <turbojpeg.h>

#include <tether/base/error.h>
#include <tether/os/text_file.h>

namespace tether::sim {
namespace {

constexpr std::size_t kLargestTexture = std::size_t{1} << 28;

[[noreturn]] void fail_texture(const std::filesystem::path& file, const std::string& what) {
  throw Error(ErrorCode::kBadFile, FileLocation{file.string()}, what);
}

// An empty picture of a size, once that is known to be small enough.
raster::Texture sized(const std::filesystem::path& file, std::int64_t width, std::int64_t height) {
  constexpr std::int64_t kMost = raster::kMaxTextureSize_px;
  if (width < 1 || height < 1 || width > kMost || height > kMost) {
    fail_texture(file, "is " + std::to_string(width) + " × " + std::to_string(height) +
                           " pixels large; a texture has 1 to 8192 each way");
  }
  raster::Texture texture{static_cast<int>(width), static_cast<int>(height), {}};
  texture.rgba.resize(static_cast<std::size_t>(4 * width * height));
  return texture;
}

raster::Texture read_png(const std::filesystem::path& file, std::string_view bytes) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  const std::unique_ptr<png_image, decltype(&png_image_free)> owner(&image, &png_image_free);
  if (png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()) == 0) {
    fail_texture(file, std::string("cannot be read as PNG: ") + image.message);
  }
  image.format = PNG_FORMAT_RGBA;
  image.flags |= PNG_IMAGE_FLAG_16BIT_sRGB;  // as those of 8 bits, if the file does not say
  raster::Texture texture = sized(file, image.width, image.height);
  if (png_image_finish_read(&image, nullptr, texture.rgba.data(), 0, nullptr) == 0) {
    fail_texture(file, std::string("cannot be read as PNG: ") + image.message);
  }
  return texture;
}

raster::Texture read_jpeg(const std::filesystem::path& file, std::string_view bytes,
                          const WarningSink& warn) {
  const std::unique_ptr<void, decltype(&tjDestroy)> reader(tjInitDecompress(), &tjDestroy);
  const auto* const data = reinterpret_cast<const unsigned char*>(bytes.data());
  const auto size = static_cast<unsigned long>(bytes.size());  // NOLINT(google-runtime-int)
  int width = 0;
  int height = 0;
  int sampling = 0;
  int space = 0;
  std::string damage;
  const auto require = [&](int result) {
    if (result == 0) return;
    damage = tjGetErrorStr2(reader.get());
    if (tjGetErrorCode(reader.get()) == TJERR_WARNING) return;
    fail_texture(file, "cannot be read as JPEG: " + damage);
  };
  require(tjDecompressHeader3(reader.get(), data, size, &width, &height, &sampling, &space));
  raster::Texture texture = sized(file, width, height);
  require(tjDecompress2(reader.get(), data, size, texture.rgba.data(), width, 0, height, TJPF_RGBA,
                        TJFLAG_ACCURATEDCT | TJFLAG_LIMITSCANS));
  if (!damage.empty()) {
    warn({Consequence::kLooksDifferent, {file.string()}, "texture", "is damaged: " + damage, true});
  }
  return texture;
}

}  // namespace

raster::Texture load_texture(const std::filesystem::path& file, const WarningSink& warn) {
  return decode_texture(os::read_file(file, kLargestTexture), file, warn);
}

raster::Texture decode_texture(std::string_view bytes, const std::filesystem::path& file,
                               const WarningSink& warn) {
  if (bytes.empty()) fail_texture(file, "is empty");
  return bytes.starts_with("\xff\xd8") ? read_jpeg(file, bytes, warn) : read_png(file, bytes);
}

}  // namespace tether::sim
