#pragma once

#include "exact.h"

#include <cstdint>

#include <tether/base/random.h>
#include <tether/record/messages.h>

namespace tether::audit {

/// What the driver of a sensor does with each sample, drawn again from the model in the header
/// (DESIGN section 2, "Stamps, lost and repeated samples"). Without a model, nothing is lost or
/// repeated.
class DriverDraws {
 public:
  DriverDraws(const record::Header& header, const record::SensorInfo& sensor);

  /// Whether the probabilities are those that a profile can have.
  bool is_valid() const;
  bool loses(std::uint64_t index) const;
  /// Whose content arrives as sample `index`.
  std::uint64_t content_of(std::uint64_t index) const;
  /// The stamp of sample `index`, which was sampled or is due at that instant.
  Wide stamp(Wide instant, std::uint64_t index) const;

 private:
  bool happens(double probability, const char* quantity, std::uint64_t index) const;
  RandomKey key(const char* quantity, std::uint64_t index) const;

  const record::SensorInfo& sensor_;
  record::DriverInfo model_;
  std::uint64_t seed_;
  bool is_synchronised_;
};

}  // namespace tether::audit
