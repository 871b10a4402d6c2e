#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include <tether/base/result.h>
#include <tether/link/codec.h>
#include <tether/sim_protocol/messages.h>

/// Frames: a little-endian uint32 length, then that many bytes of FlatBuffer (size-prefixed, root
/// `Envelope` of `schema/simulator.fbs`).
namespace tether::sim::protocol {

/// Largest frame, either way: the largest picture and its envelope.
inline constexpr std::uint32_t kMaxFrameBytes = 64u << 20;

/// Most moving bodies of a world, UAVs included.
inline constexpr std::size_t kMaxBodies = 1024;
/// Most poses in a State's past: past_steps times bodies.
inline constexpr std::size_t kMaxPastPoses = 1u << 20;
inline constexpr std::size_t kMaxRays = 1u << 16;
/// Of a picture's width and height; width × height is at most kMaxPixels.
inline constexpr std::int32_t kMaxSidePx = 16384;
inline constexpr std::int64_t kMaxPixels = 4096 * 4096;
/// Most visuals that are told how to look.
inline constexpr std::size_t kMaxLooks = 1u << 14;
/// Longest name [bytes].
inline constexpr std::size_t kMaxNameBytes = 512;
/// Longest path, description or message [bytes].
inline constexpr std::size_t kMaxTextBytes = 4096;
/// Longest SDF document of a UAV [bytes].
inline constexpr std::size_t kMaxSdfBytes = 1u << 20;

/// Whether the message may go over the wire: every number finite (a distance may be +inf), times
/// within bounds, quaternions and rays of unit length, indices within bounds, texts and lists no
/// longer than the limits above, pictures of width × height × 3 bytes. Fails with kInvalid, naming
/// the field. The version of an Open may be any.
Status validate(const Request& request);
Status validate(const Reply& reply);

/// Serialises messages into whole frames (length included). Keeps its buffer, so that all but Open
/// and Opened allocates nothing in steady use. One thread at a time. @pre validate(message).ok()
class Encoder {
 public:
  Encoder();
  ~Encoder();
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;

  /// Valid until the next call. A picture's pixels are not copied: the frame refers to them, so
  /// that it is valid only as long as `message` stays as it is.
  link::FramePieces encode(const Request& message);
  link::FramePieces encode(const Reply& message);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Decode one whole frame (length included). Verify every offset before use, then `validate`. Fail
/// with kProtocol, whatever the bytes are; never read outside of them.
Result<Request> decode_request(std::span<const std::uint8_t> frame);
Result<Reply> decode_reply(std::span<const std::uint8_t> frame);

}  // namespace tether::sim::protocol
