#pragma once

#include <tether/record/writer.h>

namespace tether::fuzz {

/// What was written, as a reader would have it, but for wall times: by these the audit finds SUTs
/// whose clocks lie, of which the barrier knows nothing.
class MemoryRecord final : public record::RecordInMemory {
 public:
  using RecordInMemory::write;
  void write(SimTime at, const record::Message& message) override {
    record::Message timeless = message;
    if (auto* interaction = std::get_if<record::Interaction>(&timeless))
      interaction->wall_at_arrival = interaction->wall_at_release = WallTime{};
    if (auto* stop = std::get_if<record::Stop>(&timeless)) stop->wall = WallTime{};
    RecordInMemory::write(at, timeless);
  }
};

}  // namespace tether::fuzz
