#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <tether/base/time.h>

namespace tether::coordinator {

/// A message that has arrived at a SUT.
struct Received {
  std::string from;
  std::uint64_t sequence = 0;
  SimTime sent_at;
  SimTime at;
  std::shared_ptr<const std::vector<std::uint8_t>> bytes;
};

}  // namespace tether::coordinator
