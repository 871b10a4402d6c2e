#include "frames.h"
#include "said_by_simulator_generated.h"

#include <tether/sim_protocol/codec.h>

/// Input: how large its pieces are, then a byte stream of the simulator protocol's frames, as
/// either side sends them.
namespace tether::fuzz {
namespace {

namespace protocol = sim::protocol;

std::unique_ptr<simulator_wire::EnvelopeT> said(Bytes frame) {
  std::vector<std::uint64_t> aligned((frame.size() + 7) / 8);
  std::memcpy(aligned.data(), frame.data(), frame.size());
  return simulator_wire::UnPackSizePrefixedEnvelope(aligned.data());
}

template <class Message>
bool check(Bytes frame, const Result<Message>& decoded) {
  const auto* message = value_or_refused(decoded, {Failure::Kind::kProtocol});
  if (message == nullptr) return false;
  require(protocol::validate(*message).ok(), "what was decoded may not be sent");
  protocol::Encoder encoder;
  const link::FramePieces pieces = encoder.encode(*message);
  std::vector<std::uint8_t> again;
  for (const Bytes piece : {pieces.head, pieces.image, pieces.tail})
    again.insert(again.end(), piece.begin(), piece.end());
  // Told by FlatBuffers' own reader, which shares no code with ours.
  require(*said(frame) == *said(again), "another meaning after decoding and encoding");
  return true;
}

void check(Bytes frame) {
  const bool is_request = check(frame, protocol::decode_request(frame));
  const bool is_reply = check(frame, protocol::decode_reply(frame));
  require(!is_request || !is_reply, "a request that is a reply");
}

}  // namespace
}  // namespace tether::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tether;
  fuzz::Choices choices({data, size});
  fuzz::for_each_frame(choices, sim::protocol::kMaxFrameBytes,
                       [](fuzz::Bytes frame) { fuzz::check(frame); });
  return 0;
}
