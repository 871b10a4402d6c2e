#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

/// The MCAP container (https://mcap.dev/spec), as far as Tether writes and reads it.
namespace tether::record {

inline constexpr std::string_view kMagic{"\x89MCAP0\r\n", 8};

enum class Opcode : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kStatistics = 0x0B,
  kMetadata = 0x0C,
  kMetadataIndex = 0x0D,
  kSummaryOffset = 0x0E,
  kDataEnd = 0x0F,
};

/// Bytes before a record's content: opcode and content length.
inline constexpr std::size_t kRecordPrefixBytes = 9;

/// CRC-32 as MCAP and zlib mean it; `crc` continues an earlier one.
std::uint32_t crc32(std::string_view bytes, std::uint32_t crc = 0);

using StringMap = std::map<std::string, std::string>;

}  // namespace tether::record
