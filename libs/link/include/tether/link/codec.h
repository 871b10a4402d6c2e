#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <tether/base/result.h>
#include <tether/link/messages.h>

/// Frames: a little-endian uint32 length, then that many bytes of FlatBuffer (root `Envelope` of
/// `schema/link.fbs`).
namespace tether::link {

inline constexpr std::size_t kFrameHeaderBytes = 4;
/// Largest frame towards the SUT: a 4096×4096 RGB image and its envelope.
inline constexpr std::uint32_t kMaxReplyBytes = 64u << 20;
/// Largest frame towards the coordinator; nothing a SUT says is long.
inline constexpr std::uint32_t kMaxRequestBytes = 1u << 20;

/// Serialises messages into whole frames (length included). Keeps its buffer, so that steady use
/// allocates nothing. Not thread-safe.
class Encoder {
 public:
  Encoder();
  ~Encoder();
  Encoder(Encoder&&) noexcept;
  Encoder& operator=(Encoder&&) noexcept;

  /// The frame; valid until the next call.
  std::span<const std::uint8_t> encode(const Message& message);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Decodes the payload of one frame (without the length). Verifies every offset before use;
/// enumerations, sizes and numbers are range-checked. Fails with Failure::Kind::kProtocol.
Result<Message> decode(std::span<const std::uint8_t> payload);

/// The length announced by a frame header. Fails if it is 0 or above `limit`.
Result<std::uint32_t> decode_frame_length(std::span<const std::uint8_t, kFrameHeaderBytes> header,
                                          std::uint32_t limit);

}  // namespace tether::link
