#include "wire_fields.h"

#include <utility>

#include <tether/sim_protocol/codec.h>
#include <tether/wire/field_checker.h>
#include <tether/wire/reader.h>
#include <tether/wire/writer.h>

namespace tether::sim::protocol {
namespace {

constexpr const char* kIdentifier = "TSIM";
/// Above anything that `validate` accepts.
constexpr std::uint32_t kMaxTables = 3 * kMaxBodies + kMaxMaterials + kMaxTouches + 16;

/// The schema has one union of both directions: the requests, then the replies.
using Content =
    std::variant<Open, Reset, Advance, CastRays, Render, Opened, State, Distances, Picture, Failed>;
struct Envelope {
  Content content;
};
void fields(auto& io, Is<Envelope> auto& m) {
  io("content", m.content);
}

/// To write a message as the content of an envelope without a copy of it.
template <class Message>
struct Sent {
  const Message& content;
};
void fields(auto& io, Is<Sent<Request>> auto& m) {
  io("content", m.content);
}
void fields(auto& io, Is<Sent<Reply>> auto& m) {
  io("content", m.content, wire::After{std::variant_size_v<Request>});
}

template <class Message>
Status validate_any(const Message& message) {
  wire::FieldChecker checker;
  checker("content", message);
  return checker.status();
}

template <class Message>
Result<Message> decode(std::span<const std::uint8_t> frame) {
  auto envelope = wire::read_frame<Envelope>(frame, kIdentifier, kMaxTables,
                                             "a message of the simulator protocol");
  if (!envelope) return envelope.failure();
  std::optional<Message> message;
  std::visit(
      [&message](auto& content) {
        if constexpr (std::is_constructible_v<Message, decltype(content)>)
          message = std::move(content);
      },
      envelope->content);
  if (!message)
    return Failure{Failure::Kind::kProtocol,
                   "bad message: not a message of this direction and version"};
  if (const Status valid = validate(*message); !valid)
    return Failure{Failure::Kind::kProtocol, "bad message: " + valid.failure().message};
  return std::move(*message);
}

}  // namespace

Status validate(const Request& request) {
  return validate_any(request);
}
Status validate(const Reply& reply) {
  return validate_any(reply);
}

struct Encoder::Impl {
  wire::FrameWriter writer;
};

Encoder::Encoder() : impl_(std::make_unique<Impl>()) {}
Encoder::~Encoder() = default;

wire::FramePieces Encoder::encode(const Request& message) {
  return impl_->writer.write(Sent<Request>{message}, kIdentifier);
}
wire::FramePieces Encoder::encode(const Reply& message) {
  return impl_->writer.write(Sent<Reply>{message}, kIdentifier);
}

Result<Request> decode_request(std::span<const std::uint8_t> frame) {
  return decode<Request>(frame);
}
Result<Reply> decode_reply(std::span<const std::uint8_t> frame) {
  return decode<Reply>(frame);
}

}  // namespace tether::sim::protocol
