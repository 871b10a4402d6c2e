#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include <tether/base/result.h>
#include <tether/link/codec.h>

namespace tether::link {

/// Cuts a byte stream into frames. Bytes go straight from the socket into it, as many as there are,
/// so that a small frame costs one system call; it grows to the largest frame seen and stays there.
/// What a header announces is not allocated before its limit has been checked.
///
///   receive into space(), commit(n), then next() until it gives an empty span.
class FrameBuffer {
 public:
  /// `limit`: the largest frame that may be announced [bytes].
  explicit FrameBuffer(std::uint32_t limit);
  /// From the next frame on.
  void set_limit(std::uint32_t limit) { limit_ = limit; }

  /// Where the next bytes go; never empty, and enough for the rest of a frame that has begun.
  /// Invalidates what next() gave.
  std::span<std::uint8_t> space();
  /// The first `count` bytes of space() have been received.
  void commit(std::size_t count) { end_ += count; }

  /// The next whole frame, length included; empty: it is not all there yet. Fails with kProtocol if
  /// a length is announced that is not allowed; there is no way on after that.
  Result<std::span<const std::uint8_t>> next();

  /// Bytes still to come of a frame whose header is there; 0 if that is not so.
  std::size_t missing() const { return frame_bytes_ > size() ? frame_bytes_ - size() : 0; }

 private:
  std::size_t size() const { return end_ - begin_; }
  void make_room(std::size_t bytes);

  std::uint32_t limit_;
  std::size_t capacity_;
  std::unique_ptr<std::uint8_t[]> data_;  // not initialised: most of it is never touched
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  std::size_t frame_bytes_ = 0;  // of the frame at begin_; 0: not known yet
};

}  // namespace tether::link
