#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace tether::record {

/// Encodes 8-bit RGB rows, top left first, as a PNG. The same pixels give the same bytes.
/// @pre rgb.size() == width_px · height_px · 3. @throws Error(kInternal) if the encoder fails.
std::vector<std::uint8_t> encode_png(int width_px, int height_px,
                                     std::span<const std::uint8_t> rgb);

/// Encodes 16-bit grey rows, top left first, as a PNG whose values are as given.
/// @pre grey.size() == width_px · height_px. @throws Error(kInternal) if the encoder fails.
std::vector<std::uint8_t> encode_png(int width_px, int height_px,
                                     std::span<const std::uint16_t> grey);

/// An image file as a data: URI, for SVG or HTML.
std::string to_data_uri(std::span<const std::uint8_t> file,
                        const std::string& media_type = "image/png");

}  // namespace tether::record
