#pragma once

#include <filesystem>
#include <memory>

#include <tether/record/messages.h>

namespace tether::record {

/// Where a run's messages go. Log times never decrease in what the coordinator writes. Not
/// thread-safe.
class Recorder {
 public:
  virtual ~Recorder() = default;
  virtual void write(const Header& header) = 0;
  virtual void write(SimTime at, const Interaction& message) = 0;
  virtual void write(SimTime at, const CommandEffect& message) = 0;
  virtual void write(SimTime at, const GroundTruth& message) = 0;
  virtual void write(SimTime at, const Annotation& message) = 0;
  virtual void write(SimTime at, const Stop& message) = 0;
  virtual void write(SimTime at, const Image& message) = 0;
  /// Everything written so far reaches the file (the system; not necessarily the disk).
  virtual void flush() = 0;
  /// The last call.
  virtual void write(const Footer& footer) = 0;
};

/// Writes an MCAP file (https://mcap.dev/spec): JSON messages with JSON schemas, zstd chunks with
/// CRCs, summary and indices at the end. A chunk goes to the file every second of ST, every
/// 1 MiB and when flushed, so that a killed run leaves a readable record. Without `write(Footer)`
/// the destructor writes the last chunk, if it can, and leaves the file without its end. The same
/// messages, flushed at the same places, give the same bytes.
/// @throws Error(kSetup) naming the file when it cannot be created or written.
std::unique_ptr<Recorder> make_mcap_recorder(const std::filesystem::path& file);

/// Keeps nothing.
std::unique_ptr<Recorder> make_null_recorder();

}  // namespace tether::record
