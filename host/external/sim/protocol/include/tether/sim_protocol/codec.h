#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include <tether/base/result.h>
#include <tether/sim_protocol/messages.h>
#include <tether/wire/fields.h>

/// Frames: a little-endian uint32 length, then that many bytes of FlatBuffer (size-prefixed, root
/// `Envelope` of `schema/simulator.fbs`).
namespace tether::sim::protocol {

/// Largest frame in either direction: the largest picture and its envelope.
inline constexpr std::uint32_t kMaxFrameBytes = 64u << 20;

/// Most moving bodies of a world, UAVs included.
inline constexpr std::size_t kMaxBodies = 1024;
/// Most poses in a State's past: past_steps times bodies.
inline constexpr std::size_t kMaxPastPoses = 1u << 20;
inline constexpr std::size_t kMaxTouches = 1u << 16;
inline constexpr std::size_t kMaxRays = 1u << 16;
/// Of a picture's width and height; width × height is at most kMaxPixels.
inline constexpr std::int32_t kMaxSidePx = 16384;
inline constexpr std::int64_t kMaxPixels = 4096 * 4096;
/// Most visuals of a world that have a material in Open.
inline constexpr std::size_t kMaxMaterials = 1u << 14;
/// Longest name [bytes].
inline constexpr std::size_t kMaxNameBytes = 512;
/// Longest path, description or message [bytes].
inline constexpr std::size_t kMaxTextBytes = 4096;
/// Longest SDF document of a UAV [bytes].
inline constexpr std::size_t kMaxSdfBytes = 1u << 20;

/// Whether the message may be sent: every number finite (a distance may be +inf), times within
/// bounds, quaternions and rays of unit length, indices within bounds, texts and lists no longer
/// than the limits above, pictures of width × height × 3 bytes. Fails with kInvalid and the field.
/// An Open may have any version.
Status validate(const Request& request);
Status validate(const Reply& reply);

/// Serialises messages into whole frames (length included). Keeps its buffer, so that all messages
/// except Open and Opened allocate nothing in steady use. One thread at a time.
/// @pre validate(message).ok()
class Encoder {
 public:
  Encoder();
  ~Encoder();
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;

  /// Valid until the next call. A picture's pixels are not copied: the frame refers to them and is
  /// valid only while `message` is unchanged.
  wire::FramePieces encode(const Request& message);
  wire::FramePieces encode(const Reply& message);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Decode one whole frame (length included) of any bytes: verify every offset before use, then
/// `validate`. Fail with kProtocol.
Result<Request> decode_request(std::span<const std::uint8_t> frame);
Result<Reply> decode_reply(std::span<const std::uint8_t> frame);

}  // namespace tether::sim::protocol
