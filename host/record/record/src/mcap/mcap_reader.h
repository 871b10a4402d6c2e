#pragma once

#include "mcap/mcap_format.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace tether::record {

/// A channel of a file.
struct McapChannel {
  std::uint16_t id = 0;
  std::string_view topic;
  std::string_view schema_name;  ///< empty: no schema
  std::string_view message_encoding;
};

/// A message; `data` lives until the call returns.
struct McapMessage {
  std::uint16_t channel = 0;
  std::uint32_t sequence = 0;
  std::uint64_t log_time_ns = 0;
  std::uint64_t publish_time_ns = 0;
  std::string_view data;
};

/// Gets the data section of an MCAP file, front to back. It may throw `Damage` to stop: the message
/// is reported with the place in the file.
class McapVisitor {
 public:
  virtual ~McapVisitor() = default;
  virtual void channel(const McapChannel& channel) = 0;
  virtual void message(const McapMessage& message) = 0;
  virtual void metadata(std::string_view name, const StringMap& values) = 0;
};

/// Reads an MCAP file without using its indices, checks every length and CRC, and stops at the
/// first damage. Returns its place and kind; empty if the file is complete.
/// @throws Error(kBadFile) when the file cannot be opened or does not begin as an MCAP file.
std::string read_mcap(const std::filesystem::path& file, McapVisitor& visitor);

}  // namespace tether::record
