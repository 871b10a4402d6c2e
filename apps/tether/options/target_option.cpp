#include "options/target_option.h"

namespace tether::app {

TargetOption parse_target_option(const std::string& text) {
  if (text.empty()) return std::monostate{};
  if (text == "wait") return WaitForSut{};
  if (text.find("://") != std::string::npos) return scenario::parse_ssh_address(text);
  return std::filesystem::path(text);
}

}  // namespace tether::app
