#include "wire_fields.h"

#include <string>
#include <utility>

#include <tether/link/codec.h>
#include <tether/wire/field_checker.h>
#include <tether/wire/reader.h>
#include <tether/wire/writer.h>

namespace tether::link {
namespace {

constexpr const char* kIdentifier = "TTHR";
/// Above anything that `validate` accepts.
constexpr std::uint32_t kMaxTables = 4 * kMaxCatalogueEntries + 16;

/// To write a message as the content of an envelope without a copy of it.
struct Sent {
  const Message& content;
};
void fields(auto& io, Is<Sent> auto& m) {
  io("content", m.content);
}

}  // namespace

Status validate(const Message& message) {
  wire::FieldChecker checker;
  checker("content", message);
  return checker.status();
}

struct Encoder::Impl {
  wire::FrameWriter writer;
};

Encoder::Encoder() : impl_(std::make_unique<Impl>()) {}
Encoder::~Encoder() = default;
Encoder::Encoder(Encoder&&) noexcept = default;
Encoder& Encoder::operator=(Encoder&&) noexcept = default;

std::span<const std::uint8_t> Encoder::encode(const Message& message) {
  impl_->writer.write(Sent{message}, kIdentifier);
  return impl_->writer.whole();
}

FramePieces Encoder::encode_pieces(const Message& message) {
  return impl_->writer.write(Sent{message}, kIdentifier);
}

Result<Message> decode(std::span<const std::uint8_t> frame) {
  auto envelope = wire::read_frame<Envelope>(frame, kIdentifier, kMaxTables, "a Tether message");
  if (!envelope) return envelope.failure();
  if (const Status valid = validate(envelope->content); !valid)
    return Failure{Failure::Kind::kProtocol, "bad message: " + valid.failure().message};
  return std::move(envelope->content);
}

Result<std::uint32_t> decode_frame_length(std::span<const std::uint8_t, kFrameHeaderBytes> header,
                                          std::uint32_t limit) {
  const std::uint32_t length = header[0] | std::uint32_t{header[1]} << 8 |
                               std::uint32_t{header[2]} << 16 | std::uint32_t{header[3]} << 24;
  std::string what;
  if (length == 0) what = "frame of length 0";
  if (length > limit)
    what = "frame of " + std::to_string(length) + " bytes announced, at most " +
           std::to_string(limit) + " allowed (is the peer a Tether program?)";
  if (what.empty()) return length;
  return Failure{Failure::Kind::kProtocol, "bad message: " + what};
}

}  // namespace tether::link
