#include "json/json_text.h"

#include <png.h>

#include <tether/base/error.h>
#include <tether/record/png.h>

namespace tether::record {
namespace {

std::vector<std::uint8_t> encode(int width_px, int height_px, png_uint_32 format,
                                 const void* pixels) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width_px);
  image.height = static_cast<png_uint_32>(height_px);
  image.format = format;
  image.flags = PNG_IMAGE_FLAG_FAST;

  // One pass into a buffer of the greatest possible size; the encoder says how much of it was used.
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::vector<std::uint8_t> png(size);
  if (!png_image_write_to_memory(&image, png.data(), &size, 0, pixels, 0, nullptr))
    throw Error(ErrorCode::kInternal,
                std::string("cannot encode an image as PNG: ") + image.message);
  png.resize(size);
  return png;
}

}  // namespace

std::vector<std::uint8_t> encode_png(int width_px, int height_px,
                                     std::span<const std::uint8_t> rgb) {
  return encode(width_px, height_px, PNG_FORMAT_RGB, rgb.data());
}

std::vector<std::uint8_t> encode_png(int width_px, int height_px,
                                     std::span<const std::uint16_t> grey) {
  return encode(width_px, height_px, PNG_FORMAT_LINEAR_Y, grey.data());
}

std::string to_data_uri(std::span<const std::uint8_t> file, const std::string& media_type) {
  std::string uri = "data:" + media_type + ";base64,";
  append_base64(uri, file);
  return uri;
}

}  // namespace tether::record
