#include "record_seeds.h"

#include "host/record/src/bytes.h"
#include "host/record/src/mcap_format.h"
#include "host/record/test/sample_messages.h"
#include "seed_file.h"

#include <zstd.h>

namespace tether::fuzz {
namespace {

using record::FieldReader;
using record::Opcode;

std::string unpacked(std::string_view packed, std::uint64_t size) {
  std::string out(static_cast<std::size_t>(size), '\0');
  ZSTD_decompress(out.data(), out.size(), packed.data(), packed.size());
  return out;
}

void append(std::string& out, Opcode opcode, std::string_view content) {
  record::append_u8(out, static_cast<std::uint8_t>(opcode));
  record::append_u64(out, content.size());
  out += content;
}

/// What of one record is left where nothing is compressed and no CRC is told.
void append_plain(std::string& out, Opcode opcode, std::string_view content) {
  FieldReader fields(content);
  if (opcode == Opcode::kChunk) {
    fields.bytes(16);  // its first and last log time
    const std::uint64_t size = fields.u64();
    fields.u32();
    fields.string();
    out += unpacked(fields.bytes(fields.u64()), size);
  } else if (opcode == Opcode::kDataEnd) {
    append(out, opcode, std::string(4, '\0'));
  } else if (opcode == Opcode::kFooter) {
    append(out, opcode, std::string(20, '\0'));
  } else if (opcode <= Opcode::kMessage || opcode == Opcode::kMetadata) {
    append(out, opcode, content);
  }
}

/// The same record without compression, CRCs and indices: each of its bytes can be changed.
std::string plain(std::string_view file) {
  const std::size_t magic = record::kMagic.size();
  std::string out(record::kMagic);
  bool is_summary = false;
  FieldReader records(file.substr(magic, file.size() - 2 * magic));
  while (!records.empty()) {
    const auto opcode = static_cast<Opcode>(records.u8());
    const std::string_view content = records.bytes(records.u64());
    if (!is_summary || opcode == Opcode::kFooter) append_plain(out, opcode, content);
    is_summary = is_summary || opcode == Opcode::kDataEnd;
  }
  return out.append(record::kMagic);
}

/// JSON schemas are most of a small file and nothing that the reader looks at.
std::string without_schema_texts(std::string_view file) {
  const std::size_t magic = record::kMagic.size();
  std::string out(record::kMagic);
  FieldReader records(file.substr(magic, file.size() - 2 * magic));
  while (!records.empty()) {
    const auto opcode = static_cast<Opcode>(records.u8());
    std::string content(records.bytes(records.u64()));
    if (opcode == Opcode::kSchema) {
      FieldReader fields(content);
      std::string kept;
      record::append_u16(kept, fields.u16());
      record::append_string(kept, fields.string());
      record::append_string(kept, fields.string());
      record::append_string(kept, "{}");
      content = kept;
    }
    append(out, opcode, content);
  }
  return out.append(record::kMagic);
}

}  // namespace

void write_record_seeds(const std::filesystem::path& folder) {
  const record::TemporaryFile file;
  record::write_whole_record(file.path());
  const std::string whole = file.bytes();
  SeedFile().add(whole).write(folder, "record", "whole");
  SeedFile().add(without_schema_texts(plain(whole))).write(folder, "record", "plain");
}

}  // namespace tether::fuzz
