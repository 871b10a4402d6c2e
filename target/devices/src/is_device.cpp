#include <algorithm>

#include <tether/devices/rig.h>

namespace tether::devices {

bool is_device(std::string_view text) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  const bool number = !text.empty() && std::all_of(text.begin(), text.end(), is_digit);
  return number || text.find('/') != std::string_view::npos || text.starts_with("iio:");
}

}  // namespace tether::devices
