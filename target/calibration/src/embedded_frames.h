#pragma once

#include <cstddef>

/// data/frame*.jpg, as bytes; made by CMake.
namespace tether::calibration {

struct EmbeddedFile {
  const unsigned char* bytes;
  std::size_t size;
};

extern const EmbeddedFile kEmbeddedFrames[];
extern const std::size_t kEmbeddedFrameCount;

}  // namespace tether::calibration
