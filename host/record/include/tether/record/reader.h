#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <tether/record/messages.h>

namespace tether::record {

template <class Message>
struct Logged {
  SimTime at;               ///< log time
  std::uint64_t order = 0;  ///< place among all of Tether's messages in the file: 0, 1, 2, …
  Message message;
};

/// A whole record in memory, each topic in file order.
struct Record {
  Header header;
  std::vector<Logged<Interaction>> interactions;
  std::vector<Logged<CommandEffect>> commands;
  std::vector<Logged<GroundTruth>> ground_truth;
  std::vector<Logged<Annotation>> annotations;
  std::vector<Logged<Stop>> stops;
  std::vector<Logged<Image>> images;
  std::optional<Footer> footer;
  /// Where and why reading stopped early (torn or damaged file), in one printable line: "damaged at
  /// byte N: …", N being where the first record of the container that is not whole begins (a chunk,
  /// for messages). Empty: read to the end.
  std::string damage;
};

struct ReadOptions {
  bool images = false;  ///< also load images
};

/// Reads front to back, checks every length and every CRC, and stops at the first damage.
/// Everything before it is had: each message of each chunk that is whole. A torn chunk gives
/// nothing: its CRC is of the whole, and zstd unpacks by 128 KiB, which is more than most chunks
/// have. How much a chunk is, `make_mcap_recorder` says. Damage to what lies between chunks may
/// show only in the CRC at the end of the data section: `damage` then names that, and what is
/// missing may be anywhere before. What is allocated is bounded by the file's size, whatever the
/// file says.
/// @throws Error(kBadFile) when the file does not exist, is no MCAP, is not Tether's, its schema is
/// newer, or it is torn before its header's end.
Record read_record(const std::filesystem::path& file, const ReadOptions& options = {});

}  // namespace tether::record
