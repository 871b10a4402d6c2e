#include <tether/base_testing/damage.h>

namespace tether {

void damage(std::vector<std::uint8_t>& bytes, KeyedRandom& random) {
  const std::uint32_t changes = 1 + random.bits() % 4;
  for (std::uint32_t i = 0; i < changes; ++i) {
    std::uint8_t& byte = bytes[random.bits() % bytes.size()];
    switch (random.bits() % 4) {
      case 0:
        byte ^= static_cast<std::uint8_t>(1u << random.bits() % 8);
        break;
      case 1:
        byte = 0xff;
        break;
      case 2:
        byte = 0;
        break;
      default:
        byte = static_cast<std::uint8_t>(random.bits());
    }
  }
}

}  // namespace tether
