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
  /// Where and why reading stopped early (torn or damaged file), in one printable line; empty: read
  /// to the end.
  std::string damage;
};

struct ReadOptions {
  bool images = false;  ///< also load images
};

/// Reads front to back, so that everything before a tear is had. Checks every length and every CRC
/// and stops at the first damage. What it allocates is bounded by the file's size, whatever the
/// file says.
/// @throws Error(kBadFile) when the file does not exist, is no MCAP, is not Tether's, its schema is
/// newer, or it is torn before its header's end.
Record read_record(const std::filesystem::path& file, const ReadOptions& options = {});

}  // namespace tether::record
