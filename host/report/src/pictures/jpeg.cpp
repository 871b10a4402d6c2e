#include "pictures/jpeg.h"

#include <memory>

#include <png.h>
#include <turbojpeg.h>

#include <tether/base/error.h>

namespace tether::report {
namespace {

constexpr int kQuality = 88;
constexpr int kChroma = TJSAMP_420;

struct Pixels {
  std::vector<std::uint8_t> rgb;
  std::uint32_t width_px = 0, height_px = 0;
};

std::optional<Pixels> decoded(std::span<const std::uint8_t> png) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_memory(&image, png.data(), png.size()) == 0) return std::nullopt;
  image.format = PNG_FORMAT_RGB;
  Pixels pixels{std::vector<std::uint8_t>(PNG_IMAGE_SIZE(image)), image.width, image.height};
  if (png_image_finish_read(&image, nullptr, pixels.rgb.data(), 0, nullptr) == 0)
    return std::nullopt;
  return pixels;
}

}  // namespace

std::optional<std::vector<std::uint8_t>> jpeg_from_png(std::span<const std::uint8_t> png) {
  const std::optional<Pixels> pixels = decoded(png);
  if (!pixels) return std::nullopt;
  const int width_px = static_cast<int>(pixels->width_px);
  const int height_px = static_cast<int>(pixels->height_px);
  std::vector<std::uint8_t> jpeg(tjBufSize(width_px, height_px, kChroma));
  unsigned char* file = jpeg.data();
  unsigned long bytes = jpeg.size();
  const std::unique_ptr<void, int (*)(tjhandle)> compressor(tjInitCompress(), tjDestroy);
  if (!compressor ||
      tjCompress2(compressor.get(), pixels->rgb.data(), width_px, 0, height_px, TJPF_RGB, &file,
                  &bytes, kChroma, kQuality, TJFLAG_ACCURATEDCT | TJFLAG_NOREALLOC) != 0)
    throw Error(ErrorCode::kInternal, "cannot encode an image as JPEG");
  jpeg.resize(bytes);
  return jpeg;
}

}  // namespace tether::report
