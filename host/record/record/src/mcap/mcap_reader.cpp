#include "mcap/mcap_reader.h"

#include "damage.h"
#include "mcap/bytes.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <fstream>
#include <map>
#include <memory>

#include <zstd.h>

#include <tether/base/error.h>
#include <tether/base/text.h>

// Reads an MCAP file (https://mcap.dev/spec) from front to back, without its indices. InputFile
// counts bytes and sums CRCs; Decompressor unpacks one chunk at a time; McapReader walks over the
// records and hands channels, messages and metadata to the visitor. All of them throw Damage at the
// first byte that is wrong, and McapReader::read adds the place.
namespace tether::record {
namespace {

// Limits on what a damaged or hostile file can make us allocate.
constexpr std::uint64_t kMaxChunkBytes = 256ULL << 20;  // unpacked
constexpr std::uint64_t kMaxUnpackRatio = 4096;         // all chunks together, to the file's size
constexpr std::uint64_t kUnpackAllowance = 64ULL << 20;
constexpr std::size_t kMaxNameBytes = 64 << 10;
constexpr std::size_t kUnpackStep = 1 << 20;

struct RawRecord {
  Opcode opcode{};
  std::string_view content;
};

// The file as bytes from front to back.
class InputFile {
 public:
  explicit InputFile(const std::filesystem::path& path) {
    std::error_code error;
    errno = 0;
    // First, because opening a pipe blocks until somebody writes to it.
    if (std::filesystem::is_regular_file(path, error)) {
      stream_.open(path, std::ios::binary);
      size_ = std::filesystem::file_size(path, error);
    }
    if (!stream_.is_open() || error) {
      require_a_handle_for(path.string());
      const std::string why = error                                        ? error.message()
                              : errno != 0                                 ? reason_of(errno)
                              : std::filesystem::is_directory(path, error) ? "it is a folder"
                              : std::filesystem::exists(path, error) ? "it is not a regular file"
                                                                     : "there is no such file";
      throw Error(ErrorCode::kBadFile, FileLocation{path.string(), 0},
                  "cannot read this record: " + why +
                      ". Give the record.mcap of a run, which is in the folder that `tether run` "
                      "names");
    }
  }

  std::uint64_t position() const { return position_; }
  std::uint64_t size() const { return size_; }
  std::uint64_t left() const { return size_ - position_; }
  bool at_end() const { return left() == 0; }
  // CRC-32 of everything read so far.
  std::uint32_t crc() const { return crc_; }
  void restart_crc() { crc_ = 0; }

  // Replaces `out` by the next `length` bytes. Nothing is allocated for bytes that are not there.
  void read(std::string& out, std::uint64_t length) {
    if (length > left())
      throw Damage("the file is truncated (" + std::to_string(left()) + " of " +
                   std::to_string(length) + " bytes)");
    out.resize(static_cast<std::size_t>(length));
    stream_.read(out.data(), static_cast<std::streamsize>(length));
    if (!stream_) throw Damage("the rest of the file cannot be read");
    position_ += length;
    crc_ = crc32(out, crc_);
  }

 private:
  std::ifstream stream_;
  std::uint64_t size_ = 0;
  std::uint64_t position_ = 0;
  std::uint32_t crc_ = 0;
};

// Unpacks zstd in steps, so that a wrong size costs at most one step.
class Decompressor {
 public:
  std::string_view unpack(std::string_view packed, std::uint64_t size) {
    ZSTD_DCtx_reset(context_.get(), ZSTD_reset_session_only);
    output_.clear();
    ZSTD_inBuffer input{packed.data(), packed.size(), 0};
    std::size_t written = 0;
    std::size_t hint = 1;
    while (hint != 0) {
      const auto room =
          static_cast<std::size_t>(std::min<std::uint64_t>(size, written + kUnpackStep));
      output_.resize(room);
      ZSTD_outBuffer output{output_.data(), output_.size(), written};
      const std::size_t before = input.pos;
      hint = ZSTD_decompressStream(context_.get(), &output, &input);
      if (ZSTD_isError(hint) || (hint != 0 && output.pos == written && input.pos == before))
        throw Damage("the compressed data of a chunk is damaged");
      written = output.pos;
    }
    if (written != size || input.pos != packed.size())
      throw Damage("the size of a chunk differs from its header");
    return std::string_view(output_).substr(0, written);
  }

 private:
  struct Free {
    void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
  };
  std::unique_ptr<ZSTD_DCtx, Free> context_{ZSTD_createDCtx()};
  std::string output_;
};

std::string_view name_field(FieldReader& fields) {
  const std::string_view name = fields.string();
  if (name.size() > kMaxNameBytes) throw Damage("a name is too long");
  return name;
}

class McapReader {
 public:
  McapReader(const std::filesystem::path& path, McapVisitor& visitor)
      : file_(path), visitor_(visitor) {
    std::string magic;
    file_.read(magic, std::min<std::uint64_t>(kMagic.size(), file_.left()));
    if (magic != kMagic) {
      throw Error(ErrorCode::kBadFile, FileLocation{path.string(), 0},
                  "not an MCAP file. Give the record.mcap of a run");
    }
  }

  std::string read() {
    try {
      read_data_section();
      read_summary();
      return {};
    } catch (const Damage& damage) {
      return printable("damaged at byte " + std::to_string(record_start_) + ": " + damage.what());
    }
  }

 private:
  RawRecord next_record() {
    record_start_ = file_.position();
    std::string prefix;
    file_.read(prefix, kRecordPrefixBytes);
    FieldReader fields(prefix);
    const auto opcode = static_cast<Opcode>(fields.u8());
    file_.read(content_, fields.u64());
    return {opcode, content_};
  }

  void read_data_section() {
    while (true) {
      const std::uint32_t crc_before = file_.crc();
      const RawRecord record = next_record();
      if (record.opcode == Opcode::kDataEnd) {
        const std::uint32_t crc = FieldReader(record.content).u32();
        if (crc != 0 && crc != crc_before) throw Damage("CRC mismatch of the data section");
        return;
      }
      if (record.opcode == Opcode::kFooter) throw Damage("the data section has no end");
      data_record(record);
    }
  }

  void data_record(const RawRecord& record) {
    FieldReader fields(record.content);
    if (record.opcode == Opcode::kChunk) {
      chunk(fields);
    } else if (record.opcode == Opcode::kMetadata) {
      metadata(fields);
    } else {
      chunk_record(record);
    }
  }

  // A record that may be inside or outside a chunk. Others (indices, attachments, those of later
  // versions) are skipped.
  void chunk_record(const RawRecord& record) {
    FieldReader fields(record.content);
    if (record.opcode == Opcode::kSchema) {
      const std::uint16_t id = fields.u16();
      schemas_[id] = name_field(fields);
    } else if (record.opcode == Opcode::kChannel) {
      channel(fields);
    } else if (record.opcode == Opcode::kMessage) {
      message(fields);
    }
  }

  void channel(FieldReader& fields) {
    McapChannel channel;
    channel.id = fields.u16();
    const std::uint16_t schema = fields.u16();
    channel.topic = name_field(fields);
    channel.message_encoding = name_field(fields);
    if (schema != 0) {
      const auto found = schemas_.find(schema);
      if (found == schemas_.end()) throw Damage("a channel has an unknown schema");
      channel.schema_name = found->second;
    }
    known_channels_[channel.id] = true;
    visitor_.channel(channel);
  }

  void message(FieldReader& fields) {
    McapMessage message;
    message.channel = fields.u16();
    message.sequence = fields.u32();
    message.log_time_ns = fields.u64();
    message.publish_time_ns = fields.u64();
    message.data = fields.all();
    if (!known_channels_[message.channel]) throw Damage("a message has an unknown channel");
    visitor_.message(message);
  }

  void metadata(FieldReader& fields) {
    const std::string_view name = name_field(fields);
    FieldReader entries(fields.string());
    StringMap values;
    while (!entries.empty()) {
      const std::string_view key = entries.string();
      values[std::string(key)] = entries.string();
    }
    visitor_.metadata(name, values);
  }

  void chunk(FieldReader& fields) {
    fields.bytes(16);  // earliest and latest log time
    const std::uint64_t size = fields.u64();
    const std::uint32_t crc = fields.u32();
    const std::string_view compression = fields.string();
    const std::string_view packed = fields.bytes(fields.u64());
    const std::string_view records = unpack(compression, packed, size);
    if (crc != 0 && crc != crc32(records)) throw Damage("CRC mismatch of a chunk");
    read_chunk(records);
  }

  std::string_view unpack(std::string_view compression, std::string_view packed,
                          std::uint64_t size) {
    unpacked_bytes_ += std::min(size, kMaxChunkBytes);
    if (size > kMaxChunkBytes ||
        unpacked_bytes_ > kUnpackAllowance + kMaxUnpackRatio * file_.size())
      throw Damage("a chunk unpacks to more than the size limit");
    if (compression == "zstd") return decompressor_.unpack(packed, size);
    if (!compression.empty())
      throw Damage("a chunk is compressed with \"" + std::string(compression.substr(0, 32)) +
                   "\". Only zstd is supported");
    if (packed.size() != size) throw Damage("the size of a chunk differs from its header");
    return packed;
  }

  void read_chunk(std::string_view records) {
    FieldReader chunk(records);
    while (!chunk.empty()) {
      RawRecord record;
      record.opcode = static_cast<Opcode>(chunk.u8());
      record.content = chunk.bytes(chunk.u64());
      if (record.opcode == Opcode::kChunk) throw Damage("a chunk contains a chunk");
      chunk_record(record);
    }
  }

  // Only to check that the file is complete: all of the summary was read before.
  void read_summary() {
    file_.restart_crc();
    while (true) {
      // The CRC covers the summary and the footer but for its last field.
      const std::uint32_t crc_before = file_.crc();
      const RawRecord record = next_record();
      if (record.opcode == Opcode::kFooter) {
        footer(record.content, crc_before);
        return;
      }
    }
  }

  void footer(std::string_view content, std::uint32_t crc_before) {
    if (content.size() != 20) throw Damage("the footer's length is wrong");
    std::string covered;
    append_u8(covered, static_cast<std::uint8_t>(Opcode::kFooter));
    append_u64(covered, content.size());
    covered += content.substr(0, 16);
    const std::uint32_t crc = FieldReader(content.substr(16)).u32();
    if (crc != 0 && crc != crc32(covered, crc_before)) throw Damage("CRC mismatch of the summary");
    record_start_ = file_.position();
    std::string magic;
    file_.read(magic, kMagic.size());
    if (magic != kMagic || !file_.at_end())
      throw Damage("the file does not end with MCAP's magic bytes");
  }

  InputFile file_;
  McapVisitor& visitor_;
  Decompressor decompressor_;
  std::string content_;
  std::uint64_t record_start_ = 0;
  std::uint64_t unpacked_bytes_ = 0;
  std::map<std::uint16_t, std::string> schemas_;
  std::array<bool, 65536> known_channels_{};
};

}  // namespace

std::string read_mcap(const std::filesystem::path& file, McapVisitor& visitor) {
  return std::make_unique<McapReader>(file, visitor)->read();
}

}  // namespace tether::record
