#include "mcap/mcap_writer.h"

#include "mcap/bytes.h"

#include <algorithm>

#include <zstd.h>

#include <tether/base/error.h>

// Messages and their schemas and channels are collected in `chunk_`. `end_chunk` compresses it,
// writes it with one index per channel, and starts a new one. Along the way the writer keeps what
// the summary repeats at the end: schemas, channels, indices of chunks and metadata, and counts.
namespace tether::record {
namespace {

constexpr std::string_view kCompression = "zstd";
// Level 1 packs a chunk of JSON to a tenth at several hundred MB/s; higher levels gain little on
// it.
constexpr int kCompressionLevel = 1;

void append_record(std::string& out, Opcode opcode, std::string_view content) {
  append_u8(out, static_cast<std::uint8_t>(opcode));
  append_u64(out, content.size());
  out.append(content);
}

// A map from channel id to a 64-bit value, its length in bytes before it.
void append_channel_map(std::string& out, const std::map<std::uint16_t, std::uint64_t>& map) {
  append_u32(out, static_cast<std::uint32_t>(map.size() * 10));
  for (const auto& [channel, value] : map) {
    append_u16(out, channel);
    append_u64(out, value);
  }
}

}  // namespace

struct McapWriter::Compressor {
  struct Free {
    void operator()(ZSTD_CCtx* made) const { ZSTD_freeCCtx(made); }
  };
  std::unique_ptr<ZSTD_CCtx, Free> context{ZSTD_createCCtx()};
  std::string output;
};

void McapWriter::TimeRange::include(std::uint64_t time_ns) {
  first = empty ? time_ns : std::min(first, time_ns);
  last = empty ? time_ns : std::max(last, time_ns);
  empty = false;
}

McapWriter::McapWriter(const std::filesystem::path& file, std::string_view library,
                       ChunkLimits limits)
    : file_(file), limits_(limits), compressor_(std::make_unique<Compressor>()) {
  chunk_.reserve(limits_.bytes + limits_.bytes / 4);
  file_.write(kMagic);
  std::string content;
  append_string(content, "");  // no profile: the topics follow no framework's conventions
  append_string(content, library);
  write_record(Opcode::kHeader, content);
  file_.end_part();
}

McapWriter::~McapWriter() = default;

std::uint16_t McapWriter::add_schema(std::string_view name, std::string_view encoding,
                                     std::string_view data) {
  const auto id = ++schema_count_;
  std::string content;
  append_u16(content, id);
  append_string(content, name);
  append_string(content, encoding);
  append_string(content, data);
  append_record(chunk_, Opcode::kSchema, content);
  append_record(schemas_, Opcode::kSchema, content);
  return id;
}

std::uint16_t McapWriter::add_channel(std::string_view topic, std::uint16_t schema,
                                      std::string_view message_encoding) {
  channel_states_.emplace_back().topic = topic;
  const auto id = static_cast<std::uint16_t>(channel_states_.size());
  std::string content;
  append_u16(content, id);
  append_u16(content, schema);
  append_string(content, topic);
  append_string(content, message_encoding);
  append_u32(content, 0);  // no metadata
  append_record(chunk_, Opcode::kChannel, content);
  append_record(channels_, Opcode::kChannel, content);
  return id;
}

std::string& McapWriter::begin_message(std::uint16_t channel, std::uint64_t log_time_ns) {
  if (!chunk_times_.empty && log_time_ns >= chunk_times_.first + limits_.span_ns) end_chunk();
  ChannelState& state = channel_states_[channel - 1U];
  state.index.push_back({log_time_ns, chunk_.size()});
  chunk_times_.include(log_time_ns);
  open_channel_ = channel;
  open_message_ = chunk_.size();

  append_u8(chunk_, static_cast<std::uint8_t>(Opcode::kMessage));
  append_u64(chunk_, 0);  // length: known in end_message
  append_u16(chunk_, channel);
  append_u32(chunk_, state.sequence++);
  append_u64(chunk_, log_time_ns);
  append_u64(chunk_, log_time_ns);  // publish time
  return chunk_;
}

void McapWriter::end_message() {
  patch_u64(chunk_, open_message_ + 1, chunk_.size() - open_message_ - kRecordPrefixBytes);
  ++channel_states_[open_channel_ - 1U].messages;
  ++message_count_;
  if (chunk_.size() >= limits_.bytes) end_chunk();
}

void McapWriter::add_metadata(std::string_view name, const StringMap& values) {
  end_chunk();
  std::string entries;
  for (const auto& [key, value] : values) {
    append_string(entries, key);
    append_string(entries, value);
  }
  std::string content;
  append_string(content, name);
  append_string(content, entries);

  std::string index;
  append_u64(index, file_.position());
  append_u64(index, content.size() + kRecordPrefixBytes);
  append_string(index, name);
  append_record(metadata_indices_, Opcode::kMetadataIndex, index);
  ++metadata_count_;
  write_record(Opcode::kMetadata, content);
  file_.end_part();
}

std::vector<TopicCount> McapWriter::counts() const {
  std::vector<TopicCount> counts;
  for (const ChannelState& state : channel_states_) counts.push_back({state.topic, state.messages});
  return counts;
}

// Where a chunk ends depends on its messages alone, not on when it was flushed.
void McapWriter::flush() {
  if (chunk_.empty() || file_.failed()) return;
  const std::string_view records = compressed_chunk();
  file_.write_ahead(chunk_prefix(records).append(records));
}

void McapWriter::end_chunk() {
  if (chunk_.empty() || file_.failed()) return;
  const std::string_view records = compressed_chunk();
  const std::uint64_t chunk_start = file_.position();
  file_.write(chunk_prefix(records));
  file_.write(records);
  file_.end_part();
  const std::uint64_t indices_start = file_.position();
  const auto index_offsets = write_message_indices();

  std::string index;
  append_u64(index, chunk_times_.first);
  append_u64(index, chunk_times_.last);
  append_u64(index, chunk_start);
  append_u64(index, indices_start - chunk_start);
  append_channel_map(index, index_offsets);
  append_u64(index, file_.position() - indices_start);
  append_string(index, kCompression);
  append_u64(index, records.size());
  append_u64(index, chunk_.size());
  append_record(chunk_indices_, Opcode::kChunkIndex, index);

  if (!chunk_times_.empty) {
    times_.include(chunk_times_.first);
    times_.include(chunk_times_.last);
  }
  ++chunk_count_;
  chunk_.clear();
  chunk_times_ = {};
}

std::string_view McapWriter::compressed_chunk() {
  std::string& output = compressor_->output;
  output.resize(std::max(output.size(), ZSTD_compressBound(chunk_.size())));
  const std::size_t size =
      ZSTD_compressCCtx(compressor_->context.get(), output.data(), output.size(), chunk_.data(),
                        chunk_.size(), kCompressionLevel);
  if (ZSTD_isError(size))
    throw Error(ErrorCode::kInternal,
                std::string("zstd cannot compress a chunk: ") + ZSTD_getErrorName(size));
  return std::string_view(output).substr(0, size);
}

std::string McapWriter::chunk_prefix(std::string_view records) const {
  std::string fields;
  append_u64(fields, chunk_times_.first);
  append_u64(fields, chunk_times_.last);
  append_u64(fields, chunk_.size());
  append_u32(fields, crc32(chunk_));
  append_string(fields, kCompression);
  append_u64(fields, records.size());

  std::string prefix;
  append_u8(prefix, static_cast<std::uint8_t>(Opcode::kChunk));
  append_u64(prefix, fields.size() + records.size());
  return prefix + fields;
}

std::map<std::uint16_t, std::uint64_t> McapWriter::write_message_indices() {
  std::map<std::uint16_t, std::uint64_t> offsets;
  std::string out;
  for (std::size_t i = 0; i < channel_states_.size(); ++i) {
    std::vector<IndexEntry>& index = channel_states_[i].index;
    if (index.empty()) continue;
    const auto channel = static_cast<std::uint16_t>(i + 1);
    offsets[channel] = file_.position() + out.size();
    std::string content;
    append_u16(content, channel);
    append_u32(content, static_cast<std::uint32_t>(index.size() * 16));
    for (const IndexEntry& entry : index) {
      append_u64(content, entry.log_time_ns);
      append_u64(content, entry.offset);
    }
    append_record(out, Opcode::kMessageIndex, content);
    index.clear();
  }
  file_.write(out);
  file_.end_part();
  return offsets;
}

void McapWriter::write_record(Opcode opcode, std::string_view content) {
  std::string record;
  append_record(record, opcode, content);
  file_.write(record);
}

void McapWriter::finish() {
  end_chunk();
  std::string end;
  append_u32(end, file_.crc());
  write_record(Opcode::kDataEnd, end);
  write_summary();
  file_.write(kMagic);
  file_.close();
}

void McapWriter::write_summary() {
  std::string statistics_record;
  append_record(statistics_record, Opcode::kStatistics, statistics());
  const std::pair<Opcode, const std::string*> groups[] = {
      {Opcode::kSchema, &schemas_},
      {Opcode::kChannel, &channels_},
      {Opcode::kChunkIndex, &chunk_indices_},
      {Opcode::kMetadataIndex, &metadata_indices_},
      {Opcode::kStatistics, &statistics_record},
  };

  const std::uint64_t start = file_.position();
  std::string summary;
  std::string offsets;
  for (const auto& [opcode, records] : groups) {
    if (records->empty()) continue;
    std::string content;
    append_u8(content, static_cast<std::uint8_t>(opcode));
    append_u64(content, start + summary.size());
    append_u64(content, records->size());
    append_record(offsets, Opcode::kSummaryOffset, content);
    summary += *records;
  }
  const std::uint64_t offsets_start = start + summary.size();
  summary += offsets;

  // The summary's CRC runs from its first byte through the footer's first two fields.
  append_u8(summary, static_cast<std::uint8_t>(Opcode::kFooter));
  append_u64(summary, 20);
  append_u64(summary, start);
  append_u64(summary, offsets_start);
  append_u32(summary, crc32(summary));
  file_.write(summary);
}

std::string McapWriter::statistics() const {
  std::map<std::uint16_t, std::uint64_t> counts;
  for (std::size_t i = 0; i < channel_states_.size(); ++i) {
    counts[static_cast<std::uint16_t>(i + 1)] = channel_states_[i].messages;
  }
  std::string content;
  append_u64(content, message_count_);
  append_u16(content, schema_count_);
  append_u32(content, static_cast<std::uint32_t>(channel_states_.size()));
  append_u32(content, 0);  // attachments
  append_u32(content, metadata_count_);
  append_u32(content, chunk_count_);
  append_u64(content, times_.first);
  append_u64(content, times_.last);
  append_channel_map(content, counts);
  return content;
}

}  // namespace tether::record
