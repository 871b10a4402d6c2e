#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include <tether/base/result.h>
#include <tether/link/messages.h>
#include <tether/wire/fields.h>

/// Frames: a little-endian uint32 length, then that many bytes of FlatBuffer (size-prefixed, root
/// `Envelope` of `schema/link.fbs`).
namespace tether::link {

inline constexpr std::size_t kFrameHeaderBytes = 4;
/// Largest frame towards the SUT: a 4096×4096 image with colours and depths, and its envelope.
inline constexpr std::uint32_t kMaxReplyBytes = 128u << 20;
/// Largest frame towards the coordinator: messages of a SUT are short.
inline constexpr std::uint32_t kMaxRequestBytes = 1u << 20;
/// Largest first frame towards the coordinator. It limits the memory for peers that are not
/// authenticated.
inline constexpr std::uint32_t kMaxHelloBytes = 32u << 10;

/// Longest name, token or topic [bytes].
using uav::kMaxNameBytes;
/// Longest text for a person: a refusal's message, an outcome [bytes].
inline constexpr std::size_t kMaxTextBytes = 4096;
/// Longest JSON text: details of an outcome, an annotation [bytes]. Nested no deeper than
/// kMaxSutJsonDepth.
inline constexpr std::size_t kMaxJsonBytes = 1000u << 10;
using uav::kMaxCatalogueEntries;
/// Longest build id [digits].
inline constexpr std::size_t kMaxBuildIdBytes = 64;
/// Most parts of a build, and the most bytes of their names and values. The frame of a Hello has
/// room for both.
inline constexpr std::size_t kMaxBuildParts = 256;
inline constexpr std::size_t kMaxBuildBytes = 20u << 10;
/// Most stages of a message.
inline constexpr std::size_t kMaxStages = 256;
using wire::kMaxTimestampNs;

/// Checks the values of a message: enumerations in range, numbers finite (a range may be ±inf),
/// timestamps, texts and lists within the limits above, images of width × height × 3 bytes, JSON
/// texts of one object. Fails with Failure::Kind::kInvalid and the name of the field. The protocol
/// version of a Hello may be any.
Status validate(const Message& message);

/// A frame in pieces, of which `image` is the pixels of the message's image.
using wire::FramePieces;

/// Serialises messages into whole frames (length included). It reuses its buffer: the messages of a
/// flight (Request, Reply, Progress, Due) allocate nothing once it is large enough. Not
/// thread-safe.
/// @pre of both calls: validate(message).ok()
class Encoder {
 public:
  Encoder();
  ~Encoder();
  Encoder(Encoder&&) noexcept;
  Encoder& operator=(Encoder&&) noexcept;

  /// The frame; valid until the next call.
  std::span<const std::uint8_t> encode(const Message& message);
  /// The same in pieces; valid until the next call, and as long as `message` stays as it is.
  FramePieces encode_pieces(const Message& message);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Decodes one whole frame (length included), from any bytes: verifies every offset before use,
/// then calls `validate`. Fails with Failure::Kind::kProtocol; never reads outside the frame.
Result<Message> decode(std::span<const std::uint8_t> frame);

/// The length in a frame header. Fails with kProtocol if it is 0 or above `limit`.
Result<std::uint32_t> decode_frame_length(std::span<const std::uint8_t, kFrameHeaderBytes> header,
                                          std::uint32_t limit);

}  // namespace tether::link
