#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string_view>

#include <tether/base/result.h>

/// Signatures of MAVLink 2 (the guide "Message Signing" of MAVLink): who has the key can make and
/// check them. Not encrypted.
namespace tether::mavlink {

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
    kWrong,  ///< another key, or a frame that was changed
    kOld,    ///< the timestamp is not later than that of the frame before from the same (link,
             ///< system, component); or the first from there, over a minute older than the newest
  };

  explicit SignatureChecker(const SigningKey& key) : key_(key) {}

  /// Of a whole frame of `system` and `component`, which ends with its signature. Only a right one
  /// changes what is accepted later. @pre frame.size() > kSignatureBytes
  Verdict check(std::span<const std::uint8_t> frame, std::uint8_t system, std::uint8_t component);

 private:
  SigningKey key_;
  std::uint64_t newest_ = 0;                                     // of all streams
  std::map<std::array<std::uint8_t, 3>, std::uint64_t> last_{};  // by link, system, component
};

}  // namespace tether::mavlink
