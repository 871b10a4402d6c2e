#pragma once

#include "mcap/bytes.h"
#include "mcap/mcap_format.h"

#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace tether::record {

/// A record of the container (https://mcap.dev/spec).
struct Raw {
  std::size_t offset;
  Opcode opcode;
  std::string_view content;
  std::size_t end() const { return offset + kRecordPrefixBytes + content.size(); }
};

/// All records of a complete file, by opcodes and lengths alone; not those in chunks.
inline std::vector<Raw> raw_records(std::string_view file) {
  EXPECT_TRUE(file.starts_with(kMagic) && file.ends_with(kMagic));
  std::vector<Raw> records;
  for (std::size_t at = kMagic.size(); at < file.size() - kMagic.size();
       at = records.back().end()) {
    FieldReader fields(file.substr(at));
    const auto opcode = static_cast<Opcode>(fields.u8());
    records.push_back({at, opcode, fields.bytes(fields.u64())});
  }
  EXPECT_EQ(records.back().end() + kMagic.size(), file.size());
  return records;
}

}  // namespace tether::record
