#include "mcap/mcap_format.h"

#include <zlib.h>

namespace tether::record {

std::uint32_t crc32(std::string_view bytes, std::uint32_t crc) {
  const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
  return static_cast<std::uint32_t>(crc32_z(crc, data, bytes.size()));
}

}  // namespace tether::record
