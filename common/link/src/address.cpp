#include <charconv>
#include <string>
#include <string_view>

#include <tether/link/channel.h>

namespace tether::link {
namespace {

Failure bad_address(const std::string& text, const std::string& why) {
  return {Failure::Kind::kInvalid, "address '" + text + "': " + why +
                                       ". Expected: host:port or [IPv6]:port, e.g. 127.0.0.1:5200"};
}

/// The end of the host within `text`, or npos; the colon before the port follows it.
std::size_t end_of_host(std::string_view text) {
  if (text.empty() || text.front() != '[') return text.find(':');
  const std::size_t bracket = text.find(']');
  return bracket == std::string_view::npos ? bracket : bracket + 1;
}

}  // namespace

Result<Address> parse_address(const std::string& text) {
  const std::size_t end = end_of_host(text);
  if (end == std::string::npos) return bad_address(text, "no port");
  if (end >= text.size() || text[end] != ':') return bad_address(text, "no port after ']'");
  const bool bracketed = text.front() == '[';
  const std::string host = bracketed ? text.substr(1, end - 2) : text.substr(0, end);
  if (host.empty()) return bad_address(text, "no host");

  const char* const first = text.data() + end + 1;
  const char* const last = text.data() + text.size();
  if (!bracketed && std::string_view(first).find(':') != std::string_view::npos) {
    return bad_address(text, "an IPv6 address needs brackets");
  }
  std::uint16_t port = 0;
  const auto [stop, error] = std::from_chars(first, last, port);
  if (error != std::errc{} || stop != last) return bad_address(text, "port is not within 0..65535");
  return Address{host, port};
}

std::string to_string(const Address& address) {
  const bool is_v6 = address.host.find(':') != std::string::npos;
  return (is_v6 ? '[' + address.host + ']' : address.host) + ':' + std::to_string(address.port);
}

}  // namespace tether::link
