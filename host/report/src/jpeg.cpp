#include "jpeg.h"

#include <csetjmp>
#include <cstdio>
#include <cstdlib>

#include <jpeglib.h>
#include <png.h>

#include <tether/base/error.h>

namespace tether::report {
namespace {

constexpr int kQuality = 88;

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

// libjpeg's way out of an error is to end the program, or to jump.
struct ErrorManager {
  jpeg_error_mgr base;
  std::jmp_buf out;
};

[[noreturn]] void jump_out(j_common_ptr compressor) {
  // The manager's first member is what libjpeg knows of it.
  std::longjmp(reinterpret_cast<ErrorManager*>(compressor->err)->out, 1);
}

// Nothing here has a destructor: the jump may leave it from anywhere.
bool compress(const Pixels& pixels, unsigned char** file, unsigned long* bytes) {
  ErrorManager errors;
  jpeg_compress_struct compressor;
  compressor.err = jpeg_std_error(&errors.base);
  errors.base.error_exit = jump_out;
  if (setjmp(errors.out) != 0) {
    jpeg_destroy_compress(&compressor);
    return false;
  }
  jpeg_create_compress(&compressor);
  jpeg_mem_dest(&compressor, file, bytes);
  compressor.image_width = pixels.width_px;
  compressor.image_height = pixels.height_px;
  compressor.input_components = 3;
  compressor.in_color_space = JCS_RGB;
  jpeg_set_defaults(&compressor);
  jpeg_set_quality(&compressor, kQuality, TRUE);
  jpeg_start_compress(&compressor, TRUE);
  while (compressor.next_scanline < compressor.image_height) {
    const std::size_t row = std::size_t{compressor.next_scanline} * pixels.width_px * 3;
    JSAMPROW line = const_cast<JSAMPROW>(pixels.rgb.data() + row);
    jpeg_write_scanlines(&compressor, &line, 1);
  }
  jpeg_finish_compress(&compressor);
  jpeg_destroy_compress(&compressor);
  return true;
}

}  // namespace

std::optional<std::vector<std::uint8_t>> jpeg_from_png(std::span<const std::uint8_t> png) {
  const std::optional<Pixels> pixels = decoded(png);
  if (!pixels) return std::nullopt;
  unsigned char* file = nullptr;
  unsigned long bytes = 0;
  const bool well = compress(*pixels, &file, &bytes);
  std::vector<std::uint8_t> jpeg(file, file + (well ? bytes : 0));
  std::free(file);
  if (!well) throw Error(ErrorCode::kInternal, "cannot encode an image as JPEG");
  return jpeg;
}

}  // namespace tether::report
