#include "camera/pixels.h"

#include "camera/jpeg.h"

#include <algorithm>
#include <cstddef>

#include <linux/videodev2.h>

namespace tether::as_is {
namespace {

struct Rgb {
  int r, g, b;
};

Rgb pixel(const std::uint8_t* rgb, int i) {
  const std::uint8_t* const p = rgb + static_cast<std::ptrdiff_t>(i) * 3;
  return {p[0], p[1], p[2]};
}
std::uint8_t byte(int value) {
  return static_cast<std::uint8_t>(value);
}

// ITU-R BT.601, as cameras for USB have it: luma 16..235, chroma 16..240 about 128.
std::uint8_t luma(const Rgb& c) {
  return byte(((66 * c.r + 129 * c.g + 25 * c.b + 128) >> 8) + 16);
}

// Of two pixels, Y U Y V. The last one of an odd width stands twice.
void to_yuyv(const std::uint8_t* rgb, int width_px, std::uint8_t* out) {
  for (int i = 0; i < width_px; i += 2, out += 4) {
    const Rgb a = pixel(rgb, i), b = pixel(rgb, std::min(i + 1, width_px - 1));
    const Rgb sum{a.r + b.r, a.g + b.g, a.b + b.b};
    out[0] = luma(a);
    out[1] = byte(((-38 * sum.r - 74 * sum.g + 112 * sum.b + 256) >> 9) + 128);
    out[2] = luma(b);
    out[3] = byte(((112 * sum.r - 94 * sum.g - 18 * sum.b + 256) >> 9) + 128);
  }
}

void to_bgr(const std::uint8_t* rgb, int width_px, std::uint8_t* out) {
  for (int i = 0; i < width_px; ++i, rgb += 3, out += 3) {
    out[0] = rgb[2];
    out[1] = rgb[1];
    out[2] = rgb[0];
  }
}

void to_rgb(const std::uint8_t* rgb, int width_px, std::uint8_t* out) {
  std::copy_n(rgb, static_cast<std::size_t>(width_px) * 3, out);
}

void to_grey(const std::uint8_t* rgb, int width_px, std::uint8_t* out) {
  for (int i = 0; i < width_px; ++i) {
    const Rgb c = pixel(rgb, i);
    out[i] = byte((77 * c.r + 150 * c.g + 29 * c.b + 128) >> 8);
  }
}

constexpr PixelFormat kFormats[] = {
    {V4L2_PIX_FMT_YUYV, "YUYV 4:2:2", 2, &to_yuyv},
    {V4L2_PIX_FMT_BGR24, "24-bit BGR 8-8-8", 3, &to_bgr},
    {V4L2_PIX_FMT_RGB24, "24-bit RGB 8-8-8", 3, &to_rgb},
    {V4L2_PIX_FMT_GREY, "8-bit Greyscale", 1, &to_grey},
    {V4L2_PIX_FMT_MJPEG, "Motion-JPEG", 0, nullptr},
};

}  // namespace

std::uint32_t PixelFormat::line_bytes(int width_px) const {
  const int even = code == V4L2_PIX_FMT_YUYV ? width_px + width_px % 2 : width_px;
  return static_cast<std::uint32_t>(even) * pixel_bytes;
}

std::uint32_t PixelFormat::image_bytes(int width_px, int height_px) const {
  if (is_compressed()) return static_cast<std::uint32_t>(most_jpeg_bytes(width_px, height_px));
  return line_bytes(width_px) * static_cast<std::uint32_t>(height_px);
}

std::uint32_t PixelFormat::convert(std::span<const std::uint8_t> rgb, int width_px, int height_px,
                                   std::uint8_t* out) const {
  if (is_compressed()) return static_cast<std::uint32_t>(write_jpeg(rgb, width_px, height_px, out));
  for (int line = 0; line < height_px; ++line)
    convert_line(rgb.data() + static_cast<std::ptrdiff_t>(line) * width_px * 3, width_px,
                 out + static_cast<std::ptrdiff_t>(line) * line_bytes(width_px));
  return image_bytes(width_px, height_px);
}

std::span<const PixelFormat> pixel_formats() {
  return kFormats;
}

const PixelFormat& pixel_format(std::uint32_t code) {
  const auto* const found = std::ranges::find(kFormats, code, &PixelFormat::code);
  return found == std::end(kFormats) ? kFormats[0] : *found;
}

}  // namespace tether::as_is
