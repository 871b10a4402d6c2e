#include <png.h>

#include <tether/rig/png.h>

namespace tether::rig {

Result<std::string> png_of(const uav::CameraSample& image) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  header.width = static_cast<png_uint_32>(image.width_px);
  header.height = static_cast<png_uint_32>(image.height_px);
  header.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(header);
  std::string png(size, '\0');
  if (png_image_write_to_memory(&header, png.data(), &size, 0, image.rgb.data(), 0, nullptr) == 0) {
    return Failure{Failure::Kind::kInvalid,
                   std::string("the image cannot be encoded as PNG: ") + header.message};
  }
  png.resize(size);
  return png;
}

}  // namespace tether::rig
