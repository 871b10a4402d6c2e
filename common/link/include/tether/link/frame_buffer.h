#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include <tether/base/result.h>
#include <tether/link/codec.h>

namespace tether::link {

/// Splits a byte stream into frames. The socket's bytes are received directly into it, as many as
/// there are, so that a small frame costs one system call. It grows to the largest frame and keeps
/// that size. The length in a header is checked against the limit before memory is allocated.
///
///   receive into space(), commit(n), then call next() until it returns an empty span.
class FrameBuffer {
 public:
  /// `limit`: the largest frame that is accepted [bytes].
  explicit FrameBuffer(std::uint32_t limit);
  /// From the next frame on.
  void set_limit(std::uint32_t limit) { limit_ = limit; }

  /// Space for the next bytes; never empty, and enough for the rest of a frame that has begun.
  /// Invalidates the frames that next() returned.
  std::span<std::uint8_t> space();
  /// The first `count` bytes of space() have been received.
  void commit(std::size_t count) { end_ += count; }

  /// The next whole frame, length included; empty if it has not arrived completely. Fails with
  /// kProtocol if its length is not allowed; the stream cannot be used after that.
  Result<std::span<const std::uint8_t>> next();

  /// Missing bytes of a frame whose header has arrived; 0 if there is none.
  std::size_t missing() const { return frame_bytes_ > size() ? frame_bytes_ - size() : 0; }
  /// Those of it that have arrived; 0 if there is none.
  std::size_t arrived() const { return missing() > 0 ? size() : 0; }

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
