#include <array>
#include <charconv>
#include <cmath>

#include <tether/toml/table.h>

namespace tether::toml {

std::string number_text(double number) {
  const double size = std::abs(number);
  const bool is_plain = size == 0.0 || (size >= 1e-4 && size < 1e16);
  std::array<char, 32> digits{};
  const auto end =
      std::to_chars(digits.data(), digits.data() + digits.size(), number,
                    is_plain ? std::chars_format::fixed : std::chars_format::scientific);
  return {digits.data(), end.ptr};
}

}  // namespace tether::toml
