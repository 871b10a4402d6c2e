#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <tether/record/messages.h>
#include <tether/record/reader.h>

namespace tether::record {

/// Receives the messages of a run: first the header, last the footer. The coordinator writes with
/// log times that never decrease. Not thread-safe.
class Recorder {
 public:
  virtual ~Recorder() = default;
  virtual void write(const Header& header) = 0;
  virtual void write(SimTime at, const Message& message) = 0;
  /// Passes everything written so far to the operating system (not necessarily to the disk).
  virtual void flush() = 0;
  /// The last call.
  virtual void write(const Footer& footer) = 0;
};

/// Writes an MCAP file (https://mcap.dev/spec): JSON messages with JSON schemas, zstd chunks with
/// CRCs, summary and indices at the end. A chunk is ended every second of ST and every 1 MiB, and
/// written by then and at each `flush`, so that a killed run leaves a readable record. Without
/// `write(Footer)` the destructor writes the last chunk if possible, and the record has no end. The
/// same messages give the same bytes, wherever they were flushed.
/// @throws Error(kSetup) with the file if it cannot be created or written. The file then keeps what
/// is whole: it reads back as the first messages. Nothing is written after a failure.
std::unique_ptr<Recorder> make_mcap_recorder(const std::filesystem::path& file);

/// The margin of a clause of a mission at an instant, judged after the run.
struct Margin {
  std::string uav;
  std::string clause;
  SimTime at;
  double margin = 0.0;  ///< in `unit`; negative: missed
  std::string unit;
};
/// Writes a file beside the record, to be opened together with it: an MCAP file whose topics
/// /margins/<uav> have one message for each margin, in the order of time.
/// @throws Error(kSetup) as make_mcap_recorder.
void write_margins(const std::filesystem::path& file, std::vector<Margin> margins);

/// Keeps the messages of a run as `read_record` returns them from its file, so that a run is
/// evaluated as its record is, without reading it. It has no images (evaluations need none, and
/// they are most of the bytes), and therefore no numbers of messages by topic in its footer.
class RecordInMemory : public Recorder {
 public:
  void write(const Header& header) override;
  void write(SimTime at, const Message& message) override;
  void flush() override {}
  void write(const Footer& footer) override;

  /// What was written so far.
  const Record& so_far() const { return record_; }
  /// The same; complete if it has a footer.
  Record take() { return std::move(record_); }

 private:
  Record record_;
  std::uint64_t order_ = 0;
};

/// Passes everything on to each of several recorders, in their order. If one throws, those after it
/// do not get the message.
class FanOut final : public Recorder {
 public:
  explicit FanOut(std::vector<Recorder*> to) : to_(std::move(to)) {}
  void write(const Header& header) override {
    pass([&](Recorder& one) { one.write(header); });
  }
  void write(SimTime at, const Message& message) override {
    pass([&](Recorder& one) { one.write(at, message); });
  }
  void flush() override {
    pass([](Recorder& one) { one.flush(); });
  }
  void write(const Footer& footer) override {
    pass([&](Recorder& one) { one.write(footer); });
  }

 private:
  void pass(const auto& give) {
    for (Recorder* one : to_) give(*one);
  }
  std::vector<Recorder*> to_;
};

}  // namespace tether::record
