#pragma once

#include "mcap/mcap_format.h"
#include "mcap/output_file.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <tether/record/messages.h>

namespace tether::record {

/// When a chunk of messages goes to the file: whichever comes first.
struct ChunkLimits {
  std::uint64_t bytes = 1024 * 1024;
  std::uint64_t span_ns = 1'000'000'000;  ///< of log time
};

/// Writes an MCAP file: messages in zstd chunks with CRCs and message indices, metadata between
/// them, summary and offsets at the end. Knows nothing of the contents of messages. The same calls
/// but `flush` give the same bytes. Call order: channels after their schema, messages after their
/// channel, `finish` last. Without `finish` (after `flush` and a crash, or a failed write) the file
/// is the beginning of a valid one, up to the end of a chunk or of metadata.
/// @throws Error(kSetup) with the file if it cannot be created or written. Not thread-safe.
class McapWriter {
 public:
  McapWriter(const std::filesystem::path& file, std::string_view library, ChunkLimits limits = {});
  ~McapWriter();

  std::uint16_t add_schema(std::string_view name, std::string_view encoding, std::string_view data);
  std::uint16_t add_channel(std::string_view topic, std::uint16_t schema,
                            std::string_view message_encoding);

  /// Where to append the message's bytes. `end_message` must follow before any other call.
  std::string& begin_message(std::uint16_t channel, std::uint64_t log_time_ns);
  void end_message();

  /// Goes straight to the file, after all messages so far.
  void add_metadata(std::string_view name, const StringMap& values);

  /// The messages of each channel so far, in the order of channels.
  std::vector<TopicCount> counts() const;

  /// Hands the open chunk to the system, and keeps it open.
  void flush();
  /// Closes data section and file: the last call.
  void finish();

 private:
  struct IndexEntry {
    std::uint64_t log_time_ns;
    std::uint64_t offset;
  };
  struct ChannelState {
    std::string topic;
    std::uint32_t sequence = 0;
    std::uint64_t messages = 0;
    std::vector<IndexEntry> index;  ///< of the open chunk
  };
  struct TimeRange {
    std::uint64_t first = 0;
    std::uint64_t last = 0;
    bool empty = true;
    void include(std::uint64_t time_ns);
  };
  struct Compressor;

  void end_chunk();
  std::string_view compressed_chunk();
  std::string chunk_prefix(std::string_view records) const;
  std::map<std::uint16_t, std::uint64_t> write_message_indices();
  void write_record(Opcode opcode, std::string_view content);
  void write_summary();
  std::string statistics() const;

  OutputFile file_;
  ChunkLimits limits_;
  std::unique_ptr<Compressor> compressor_;

  // The open chunk.
  std::string chunk_;
  TimeRange chunk_times_;
  std::uint16_t open_channel_ = 0;
  std::size_t open_message_ = 0;  ///< offset of the message's record in `chunk_`

  // What the summary repeats: whole records, in the order of writing.
  std::string schemas_;
  std::string channels_;
  std::string chunk_indices_;
  std::string metadata_indices_;
  std::uint16_t schema_count_ = 0;
  std::vector<ChannelState> channel_states_;  ///< at channel id − 1
  TimeRange times_;
  std::uint64_t message_count_ = 0;
  std::uint32_t chunk_count_ = 0;
  std::uint32_t metadata_count_ = 0;
};

}  // namespace tether::record
