#pragma once

#include <tether/record/reader.h>
#include <tether/record/writer.h>

namespace tether::fuzz {

/// What was written, as a reader would have it, but for wall times: by these the audit finds SUTs
/// whose clocks lie, of which the barrier knows nothing.
class MemoryRecord final : public record::Recorder {
 public:
  void write(const record::Header& m) override { record.header = m; }
  void write(SimTime at, const record::Interaction& m) override {
    add(record.interactions, at, m);
    record.interactions.back().message.wall_at_arrival = WallTime{};
    record.interactions.back().message.wall_at_release = WallTime{};
  }
  void write(SimTime at, const record::CommandEffect& m) override { add(record.commands, at, m); }
  void write(SimTime at, const record::GroundTruth& m) override { add(record.ground_truth, at, m); }
  void write(SimTime at, const record::Annotation& m) override { add(record.annotations, at, m); }
  void write(SimTime at, const record::Stop& m) override {
    add(record.stops, at, m);
    record.stops.back().message.wall = WallTime{};
  }
  void write(SimTime at, const record::Contact& m) override { add(record.contacts, at, m); }
  void write(SimTime at, const record::Battery& m) override { add(record.batteries, at, m); }
  void write(SimTime at, const record::RadioMessage& m) override { add(record.radio, at, m); }
  void write(SimTime at, const record::Image& m) override { add(record.images, at, m); }
  void write(SimTime at, const record::RawImage& m) override { add(record.raw_images, at, m); }
  void flush() override {}
  void write(const record::Footer& m) override { record.footer = m; }

  record::Record record;

 private:
  template <class Messages, class Message>
  void add(Messages& messages, SimTime at, const Message& message) {
    messages.push_back({at, order_++, message});
  }
  std::uint64_t order_ = 0;
};

}  // namespace tether::fuzz
