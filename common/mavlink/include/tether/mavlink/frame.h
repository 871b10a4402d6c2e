#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numbers>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <tether/base/result.h>
#include <tether/mavlink/message.h>
#include <tether/uav/math.h>

namespace tether::mavlink {

// ---- Signatures of MAVLink 2 (the guide "Message Signing" of MAVLink): who has the key can make
// and check them. Not encrypted.

using SigningKey = std::array<std::uint8_t, 32>;

/// The key that other MAVLink programs make of the same passphrase: its SHA-256.
SigningKey key_of_passphrase(std::string_view passphrase);
/// A key file: 32 bytes, or 64 hexadecimal digits with white space around them. Fails (kInvalid)
/// for anything else.
Result<SigningKey> key_of_file(std::string_view content);

/// What a signed frame has after its checksum: link id, timestamp, signature.
inline constexpr std::size_t kSignatureBytes = 13;
/// Timestamps count 10 µs since 2015-01-01 UTC, in 48 bits.
inline constexpr std::uint64_t kLastTimestamp = (std::uint64_t{1} << 48) - 1;
inline constexpr std::uint64_t kTimestampsPerMinute = 6'000'000;

/// Signs the frames that one sender sends on one link. Not thread-safe.
class Signer {
 public:
  /// The first frame has at least `timestamp`.
  Signer(const SigningKey& key, std::uint8_t link, std::uint64_t timestamp)
      : key_(key), link_(link), next_(timestamp) {}

  /// The next frame has at least `timestamp`. Earlier times change nothing: timestamps increase.
  void advance_to(std::uint64_t timestamp);
  /// Of `frame`, which begins with its first byte and ends with its checksum.
  /// @pre fewer than 2^48 timestamps were used
  std::array<std::uint8_t, kSignatureBytes> sign(std::span<const std::uint8_t> frame);

 private:
  SigningKey key_;
  std::uint8_t link_;
  std::uint64_t next_;
};

/// Checks signatures, and that no frame is received twice. Not thread-safe.
class SignatureChecker {
 public:
  enum class Verdict {
    kRight,
    kNotSigned,
    kWrong,  ///< another key, or a frame that was changed
    kOld,    ///< the timestamp is not later than that of the frame before from the same (link,
             ///< system, component); or the first from there, over a minute older than the newest
  };

  /// Of a receiver whose own clock is at `timestamp`.
  explicit SignatureChecker(const SigningKey& key, std::uint64_t timestamp = 0)
      : key_(key), newest_(timestamp) {}

  /// Of a whole frame of `system` and `component`, which ends with its signature. Only a right one
  /// changes what is accepted later. @pre frame.size() > kSignatureBytes
  Verdict check(std::span<const std::uint8_t> frame, std::uint8_t system, std::uint8_t component);
  /// The newest timestamp that was right.
  std::uint64_t newest() const { return newest_; }

 private:
  SigningKey key_;
  std::uint64_t newest_;                                         // of all streams
  std::map<std::array<std::uint8_t, 3>, std::uint64_t> last_{};  // by link, system, component
};

/// Signs for a program that does not, and checks what it is to receive: frames of any message, also
/// of such that are not in the table. Not thread-safe.
class SignedLink {
 public:
  /// `timestamp`: the time at which the link begins.
  SignedLink(const SigningKey& key, std::uint8_t link, std::uint64_t timestamp)
      : signer_(key, link, timestamp), checker_(key, timestamp) {}

  /// The frames of MAVLink 2 of a datagram, signed at that time or later; the rest as it is.
  std::vector<std::uint8_t> sign(std::span<const std::uint8_t> datagram, std::uint64_t timestamp);
  struct Opened {
    SignatureChecker::Verdict verdict = SignatureChecker::Verdict::kNotSigned;
    std::vector<std::uint8_t> frames{};  ///< without signatures, and without what is between them
  };
  /// Of a datagram. It is right if all of its frames are, and it has one.
  Opened open(std::span<const std::uint8_t> datagram);

 private:
  Signer signer_;
  SignatureChecker checker_;
};

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

// Between the frames of MAVLink (the world NED, the body FRD) and Tether's (ENU, FLU; REP-103).

constexpr uav::Vec3 ned_from_enu(const uav::Vec3& v) {
  return {v.y, v.x, -v.z};
}
constexpr uav::Vec3 enu_from_ned(const uav::Vec3& v) {
  return {v.y, v.x, -v.z};
}
constexpr uav::Vec3 frd_from_flu(const uav::Vec3& v) {
  return {v.x, -v.y, -v.z};
}
constexpr uav::Vec3 flu_from_frd(const uav::Vec3& v) {
  return {v.x, -v.y, -v.z};
}

/// The attitude of FRD in NED, of that of FLU in ENU: q_NED_FRD = q_NED_ENU q_ENU_FLU q_FLU_FRD.
/// Both outer rotations are half turns, about (1, 1, 0)/√2 and about x.
inline uav::Quat ned_from_enu(const uav::Quat& q_ENU_FLU) {
  constexpr double kHalf = std::numbers::sqrt2 / 2.0;
  const uav::Quat q = uav::Quat{0.0, kHalf, kHalf, 0.0} * q_ENU_FLU * uav::Quat{0.0, 1.0, 0.0, 0.0};
  return q.w < 0.0 ? uav::Quat{-q.w, -q.x, -q.y, -q.z} : q;
}
/// The inverse, by the same half turns.
inline uav::Quat enu_from_ned(const uav::Quat& q_NED_FRD) {
  return ned_from_enu(q_NED_FRD);
}

/// Yaw clockwise from north, of one counter-clockwise from east; in (−π, π].
inline double ned_from_enu_yaw(double yaw_rad) {
  const double turned = std::remainder(std::numbers::pi / 2.0 - yaw_rad, 2.0 * std::numbers::pi);
  return turned <= -std::numbers::pi ? std::numbers::pi : turned;
}
/// The inverse.
inline double enu_from_ned_yaw(double yaw_rad) {
  return ned_from_enu_yaw(yaw_rad);
}

}  // namespace tether::mavlink
