#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace tether::report {

/// A PNG file as a JPEG file of a tenth of its size, at a loss that one does not see. None when it
/// is no PNG that can be read. @throws Error(kInternal) if the encoder fails.
std::optional<std::vector<std::uint8_t>> jpeg_from_png(std::span<const std::uint8_t> png);

}  // namespace tether::report
