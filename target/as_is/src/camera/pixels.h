#pragma once

#include <cstdint>
#include <span>

namespace tether::as_is {

/// A format of images, as V4L2 names it.
struct PixelFormat {
  std::uint32_t code;  ///< V4L2_PIX_FMT_…
  const char* name;
  std::uint32_t pixel_bytes;  ///< 0: compressed
  void (*convert_line)(const std::uint8_t* rgb, int width_px, std::uint8_t* out);  ///< if it is not

  bool is_compressed() const { return pixel_bytes == 0; }
  /// 0: it has no lines.
  std::uint32_t line_bytes(int width_px) const;
  /// At most.
  std::uint32_t image_bytes(int width_px, int height_px) const;
  /// From height × width × 3 sRGB bytes. @return how many bytes of `out` it takes
  std::uint32_t convert(std::span<const std::uint8_t> rgb, int width_px, int height_px,
                        std::uint8_t* out) const;
};

/// Those that simulated cameras have. The first one is what they begin with.
std::span<const PixelFormat> pixel_formats();
/// That of this code; the first one, if there is none.
const PixelFormat& pixel_format(std::uint32_t code);

}  // namespace tether::as_is
