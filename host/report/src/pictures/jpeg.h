#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace tether::report {

/// A PNG file as a JPEG file of a tenth of its size, with no visible loss. None if it is not a
/// readable PNG. @throws Error(kInternal) if the encoder fails.
std::optional<std::vector<std::uint8_t>> jpeg_from_png(std::span<const std::uint8_t> png);

}  // namespace tether::report
