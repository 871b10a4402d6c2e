#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include <tether/record/reader.h>
#include <tether/record/writer.h>

namespace tether::record {

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
