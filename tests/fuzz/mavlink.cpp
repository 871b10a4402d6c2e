#include "fuzz_target.h"

#include <bit>

#include <tether/mavlink/frame.h>

/// Input: a byte of choices, then either a stream of bytes as a peer may send it, or what a message
/// of ours has.
namespace tether::fuzz {
namespace {

using mavlink::Decoder;
using mavlink::Field;
using mavlink::Frame;
using mavlink::Message;

bool same(const Frame& a, const Frame& b) {
  return a.from == b.from && a.sequence == b.sequence && &a.message.type() == &b.message.type() &&
         std::ranges::equal(a.message.payload(), b.message.payload());
}

void check_frame(const Frame& frame) {
  for (const Field& field : frame.message.type().fields) {
    for (std::size_t i = 0; i < field.count; ++i) {
      frame.message.number(field.name, i);
      frame.message.integer(field.name, i);
    }
    if (field.type == mavlink::Type::kChar)
      require(frame.message.text(field.name).size() <= field.count, "a text beyond its field");
  }
  const auto again = Decoder().push(mavlink::encode(frame.message, frame.from, frame.sequence));
  require(again.size() == 1 && same(again[0], frame), "another frame when encoded and read again");
}

// The frames of a stream do not depend on its pieces, and all bytes are accounted for.
void check_stream(Choices choices) {
  const std::size_t piece = 1 + choices.below(64);
  const Bytes stream = choices.rest();
  Decoder whole, in_pieces, datagram;
  const auto frames = whole.push(stream);
  std::size_t count = 0;
  while (!choices.empty()) {
    for (const Frame& frame : in_pieces.push(choices.take(piece))) {
      require(count < frames.size() && same(frame, frames[count]), "other frames in pieces");
      ++count;
    }
  }
  require(count == frames.size(), "fewer frames in pieces");
  for (const Frame& frame : frames) check_frame(frame);
  require(datagram.push_datagram(stream).size() >= frames.size(), "fewer frames in a datagram");
  for (const auto& counts : {whole.counts(), in_pieces.counts(), datagram.counts()})
    require(counts.skipped_bytes + frames.size() <= stream.size(), "more skipped than there was");
  const auto key = mavlink::key_of_passphrase("a secret of nobody");
  require(Decoder(&key).push(stream).empty(), "a frame without the key");
}

// What we send is read, if nobody has changed it.
void check_message(Choices choices) {
  const auto types = mavlink::message_types();
  Message message(types[choices.below(types.size())]);
  for (const Field& field : message.type().fields) {
    if (choices.coin()) continue;
    const std::size_t i = choices.below(field.count);
    if (choices.coin())
      message.set(field.name, choices.number(), i);
    else
      message.set(field.name, std::bit_cast<double>(choices.word()), i);
  }
  const auto key = mavlink::key_of_passphrase(choices.text());
  mavlink::Signer signer(key, choices.byte(), choices.word() >> 20U);
  auto bytes = mavlink::encode(message, {choices.byte(), choices.byte()}, choices.byte(), &signer);
  require(Decoder(&key).push_datagram(bytes).size() == 1, "a frame of ours is not taken");
  if (choices.empty()) return;
  bytes[choices.byte() % bytes.size()] ^= static_cast<std::uint8_t>(1U << choices.below(8));
  require(Decoder(&key).push_datagram(bytes).empty(), "a frame that was changed is taken");
}

}  // namespace
}  // namespace tether::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tether;
  fuzz::Choices choices({data, size});
  switch (choices.below(4)) {
    case 0:
      fuzz::value_or_refused(mavlink::key_of_file(fuzz::text_of(choices.rest())),
                             {Failure::Kind::kInvalid});
      break;
    case 1:
      fuzz::check_message(choices);
      break;
    default:
      fuzz::check_stream(choices);
  }
  return 0;
}
