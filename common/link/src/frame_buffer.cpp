
#include <algorithm>
#include <cstring>

#include <tether/link/socket.h>

namespace tether::link {
namespace {

constexpr std::size_t kUsualBytes = 64u << 10;
constexpr std::size_t kLeastSpaceBytes = 4u << 10;

}  // namespace

FrameBuffer::FrameBuffer(std::uint32_t limit)
    : limit_(limit),
      capacity_(std::min(kUsualBytes, kFrameHeaderBytes + limit + kLeastSpaceBytes)),
      data_(new std::uint8_t[capacity_]) {}

std::span<std::uint8_t> FrameBuffer::space() {
  if (begin_ == end_) begin_ = end_ = 0;
  make_room(std::max(missing(), kLeastSpaceBytes));
  return {data_.get() + end_, capacity_ - end_};
}

void FrameBuffer::make_room(std::size_t bytes) {
  if (capacity_ - end_ >= bytes) return;
  const std::size_t kept = size();
  if (kept + bytes <= capacity_) {
    std::memmove(data_.get(), data_.get() + begin_, kept);
  } else {
    const std::size_t usual = std::min<std::size_t>(kUsualBytes, limit_);
    const std::size_t capacity = std::max(kept + bytes + kLeastSpaceBytes, usual);
    std::unique_ptr<std::uint8_t[]> data(new std::uint8_t[capacity]);
    std::memcpy(data.get(), data_.get() + begin_, kept);
    data_ = std::move(data);
    capacity_ = capacity;
  }
  begin_ = 0;
  end_ = kept;
}

Result<std::span<const std::uint8_t>> FrameBuffer::next() {
  using Frame = std::span<const std::uint8_t>;
  frame_bytes_ = 0;
  if (size() < kFrameHeaderBytes) return Frame{};
  const auto length = decode_frame_length(
      std::span<const std::uint8_t, kFrameHeaderBytes>(data_.get() + begin_, kFrameHeaderBytes),
      limit_);
  if (!length) return length.failure();
  const std::size_t bytes = kFrameHeaderBytes + *length;
  if (size() < bytes) {
    frame_bytes_ = bytes;
    return Frame{};
  }
  const Frame frame{data_.get() + begin_, bytes};
  begin_ += bytes;
  return frame;
}

}  // namespace tether::link
