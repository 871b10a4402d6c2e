#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace tether::wire {

/// A frame in up to three consecutive pieces. `image` are bytes of the message itself, its pixels,
/// so that an image is sent without a copy; it is empty for messages without an image.
struct FramePieces {
  std::span<const std::uint8_t> head;
  std::span<const std::uint8_t> image;
  std::span<const std::uint8_t> tail;

  std::size_t size() const { return head.size() + image.size() + tail.size(); }
};

}  // namespace tether::wire
