#include <algorithm>
#include <cctype>
#include <charconv>

#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/scenario/target.h>

namespace tether::scenario {

namespace {

constexpr std::string_view kScheme = "ssh://";

[[noreturn]] void fail(std::string_view text, const std::string& why) {
  throw Error(ErrorCode::kUsage,
              fmt::format("\"{}\": {}. Expected ssh://[user@]host[:port], for instance "
                          "ssh://pi@board.local.",
                          text, why))
      .about(std::string(text));
}

/// Whether ssh can only read it as a name: not an option, no blank, no character special to a
/// shell.
bool is_name(std::string_view name) {
  return !name.empty() && name.front() != '-' && std::ranges::all_of(name, [](unsigned char c) {
    return std::isalnum(c) != 0 ||
           std::string_view("._-:%+").find(static_cast<char>(c)) != std::string_view::npos;
  });
}

int read_port(std::string_view text, std::string_view digits) {
  int port = 0;
  const char* const last = digits.data() + digits.size();
  const auto [stop, error] = std::from_chars(digits.data(), last, port);
  if (error != std::errc{} || stop != last || port < 1 || port > 65535)
    fail(text, "the port must be 1 to 65535");
  return port;
}

/// The end of the host within "host[:port]" or "[IPv6][:port]".
std::size_t end_of_host(std::string_view text, std::string_view host) {
  if (!host.starts_with('[')) return std::min(host.find(':'), host.size());
  const std::size_t bracket = host.find(']');
  if (bracket == std::string_view::npos) fail(text, "no ']'");
  return bracket + 1;
}

}  // namespace

SshAddress parse_ssh_address(std::string_view text) {
  if (!text.starts_with(kScheme)) fail(text, "not the address of a board");
  std::string_view rest = text.substr(kScheme.size());
  if (rest.ends_with('/')) rest.remove_suffix(1);
  const std::size_t at = rest.rfind('@');
  const std::string_view user =
      at == std::string_view::npos ? std::string_view() : rest.substr(0, at);
  if (at != std::string_view::npos) {
    if (user.find(':') != std::string_view::npos)
      fail(text, "contains a password. Tether uses your SSH keys");
    if (!is_name(user)) fail(text, "the user before '@' is missing or not a name for ssh");
    rest.remove_prefix(at + 1);
  }

  const std::size_t end = end_of_host(text, rest);
  const bool is_bracketed = rest.starts_with('[');
  const std::string_view host = is_bracketed ? rest.substr(1, end - 2) : rest.substr(0, end);
  if (!is_name(host)) fail(text, "the host is missing or not a name for ssh");
  const std::string_view after = rest.substr(end);
  if (!after.empty() && after.front() != ':') fail(text, "expected a port after ']'");
  SshAddress address;
  address.destination = user.empty() ? std::string(host) : fmt::format("{}@{}", user, host);
  address.port = after.empty() ? 0 : read_port(text, after.substr(1));
  return address;
}

std::string to_string(const SshAddress& address) {
  const std::size_t at = address.destination.rfind('@');
  const std::size_t begin = at == std::string::npos ? 0 : at + 1;
  std::string host = address.destination.substr(begin);
  if (host.find(':') != std::string::npos) host = '[' + host + ']';
  return fmt::format("{}{}{}{}", kScheme, address.destination.substr(0, begin), host,
                     address.port == 0 ? "" : fmt::format(":{}", address.port));
}

}  // namespace tether::scenario
