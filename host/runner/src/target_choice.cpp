#include "options/target_option.h"

namespace tether::app {

TargetOption parse_target_option(const std::string& text) {
  if (text.empty()) return std::monostate{};
  if (text == "wait") return WaitForSut{};
  const bool is_address = text.find("://") != std::string::npos || text.starts_with("ssh:") ||
                          (text.find('@') != std::string::npos && text.find('/') == text.npos);
  if (is_address) return scenario::parse_ssh_address(text);  // or says what is wrong with it
  return std::filesystem::path(text);
}

}  // namespace tether::app
