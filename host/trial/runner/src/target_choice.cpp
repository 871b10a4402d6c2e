#include <tether/runner/trial_request.h>

namespace tether::runner {

namespace {

constexpr const char* kWait = "wait";

struct Text {
  std::string operator()(std::monostate) const { return ""; }
  std::string operator()(const std::filesystem::path& file) const { return file.string(); }
  std::string operator()(const scenario::SshAddress& address) const { return to_string(address); }
  std::string operator()(WaitForSut) const { return kWait; }
};

}  // namespace

TargetChoice parse_target_choice(const std::string& text) {
  if (text.empty()) return std::monostate{};
  if (text == kWait) return WaitForSut{};
  const bool is_address = text.find("://") != std::string::npos || text.starts_with("ssh:") ||
                          (text.find('@') != std::string::npos && text.find('/') == text.npos);
  if (is_address) return scenario::parse_ssh_address(text);  // or says what is wrong with it
  return std::filesystem::path(text);
}

std::string to_text(const TargetChoice& choice) {
  return std::visit(Text{}, choice);
}

}  // namespace tether::runner
