#include "frames.h"
#include "said_by_link_generated.h"

#include <tether/link/codec.h>

/// Input: how large its pieces are, then a byte stream of the link's frames, as either side sends
/// them.
namespace tether::fuzz {
namespace {

std::unique_ptr<link_wire::EnvelopeT> said(Bytes frame) {
  std::vector<std::uint64_t> aligned((frame.size() + 7) / 8);
  std::memcpy(aligned.data(), frame.data(), frame.size());
  return link_wire::UnPackSizePrefixedEnvelope(aligned.data());
}

void check(Bytes frame) {
  const auto decoded = link::decode(frame);
  const auto* message = value_or_refused(decoded, {Failure::Kind::kProtocol});
  if (message == nullptr) return;
  require(link::validate(*message).ok(), "what was decoded may not be sent");
  link::Encoder encoder;
  const auto again = encoder.encode(*message);
  require(link::decode(again).ok(), "what was encoded again cannot be decoded");
  // Told by FlatBuffers' own reader, which shares no code with ours.
  require(*said(frame) == *said(again), "another meaning after decoding and encoding");
}

}  // namespace
}  // namespace tether::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tether;
  fuzz::Choices choices({data, size});
  const bool to_sut = choices.coin();
  fuzz::for_each_frame(choices, to_sut ? link::kMaxReplyBytes : link::kMaxRequestBytes,
                       fuzz::check);
  return 0;
}
