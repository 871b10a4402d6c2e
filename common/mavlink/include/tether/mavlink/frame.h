#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <tether/mavlink/message.h>
#include <tether/mavlink/signing.h>

namespace tether::mavlink {

/// Who sends.
struct Address {
  std::uint8_t system = 0;
  std::uint8_t component = 0;
  friend bool operator==(const Address&, const Address&) = default;
};

struct Frame {
  Address from;
  std::uint8_t sequence = 0;
  int version = 2;  ///< of MAVLink
  bool is_signed = false;
  Message message;
};

/// A frame of MAVLink 2, with a signature if there is a signer. Zeros at the end of the payload are
/// left out.
std::vector<std::uint8_t> encode(const Message& message, Address from, std::uint8_t sequence,
                                 Signer* signer = nullptr);

/// What was in a stream beside frames of the table.
struct DecoderCounts {
  std::uint64_t skipped_bytes = 0;    ///< between frames
  std::uint64_t wrong_checksums = 0;  ///< of frames of the table
  std::uint64_t unknown = 0;          ///< frames of messages that are not in the table
  std::uint64_t incompatible = 0;     ///< frames with flags that are not known
  // With a key:
  std::uint64_t not_signed = 0;
  std::uint64_t wrong_signatures = 0;
  std::uint64_t old_signatures = 0;  ///< right, but of frames that were received before
};

/// Reads frames of MAVLink 1 and 2 from a stream of bytes, whatever these are. Not thread-safe.
class Decoder {
 public:
  /// With a key, only frames that are signed with it are taken; without one, no signature is
  /// checked.
  explicit Decoder(const SigningKey* key = nullptr) {
    if (key != nullptr) checker_.emplace(*key);
  }

  /// More bytes, in any pieces. Returns the frames that they complete, in order.
  std::vector<Frame> push(std::span<const std::uint8_t> bytes);
  /// A datagram, in which frames are whole: nothing waits for bytes of the next one. For one
  /// decoder, either this or `push`.
  std::vector<Frame> push_datagram(std::span<const std::uint8_t> bytes);
  const DecoderCounts& counts() const { return counts_; }

 private:
  enum class Outcome { kFrame, kWait, kSkip };
  std::vector<Frame> take_all(bool waits);
  Outcome take(std::span<const std::uint8_t> bytes, bool waits, std::size_t& used,
               std::vector<Frame>& frames);
  bool is_authentic(std::span<const std::uint8_t> bytes, const Frame& frame);

  std::vector<std::uint8_t> rest_;  // of what may become a frame
  DecoderCounts counts_;
  std::optional<SignatureChecker> checker_;
};

}  // namespace tether::mavlink
