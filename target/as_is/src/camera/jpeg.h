#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace tether::as_is {

/// Most bytes that an image can take: twice what its coefficients need without any compression.
std::size_t most_jpeg_bytes(int width_px, int height_px);

/// An image as the JPEG encoder of a camera for USB writes it: baseline (ITU-T T.81), JFIF's YCbCr
/// with half of the chroma along lines (4:2:2), quality 90. The same bytes on any machine.
/// @param rgb height × width × 3 sRGB bytes
/// @param out has room for `most_jpeg_bytes`
/// @return how many bytes it has
std::size_t write_jpeg(std::span<const std::uint8_t> rgb, int width_px, int height_px,
                       std::uint8_t* out);

}  // namespace tether::as_is
