#include <tether/base_testing/damage.h>

namespace tether {

void damage(std::vector<std::uint8_t>& bytes, KeyedRandom& random) {
  const std::uint32_t changes = 1 + random.bits() % 4;
  for (std::uint32_t i = 0; i < changes; ++i) {
    std::uint8_t& byte = bytes[random.bits() % bytes.size()];
    const std::uint32_t flipped = byte ^ 1u << random.bits() % 8;
    const std::uint32_t values[] = {flipped, 0xff, 0, random.bits()};
    byte = static_cast<std::uint8_t>(values[random.bits() % 4]);
  }
}

}  // namespace tether
