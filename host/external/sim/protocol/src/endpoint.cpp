#include <string>
#include <string_view>
#include <utility>

#include <tether/sim_protocol/connection.h>

namespace tether::sim::protocol {
namespace {

constexpr std::string_view kUnix = "unix:";
constexpr std::string_view kTcp = "tcp://";

}  // namespace

Result<Endpoint> parse_endpoint(const std::string& text) {
  if (text.starts_with(kUnix) && text.size() > kUnix.size()) {
    return Endpoint(std::filesystem::path(text.substr(kUnix.size())));
  }
  if (text.starts_with(kTcp)) {
    auto address = link::parse_address(text.substr(kTcp.size()));
    if (!address) return address.failure();
    return Endpoint(std::move(*address));
  }
  return Failure{Failure::Kind::kInvalid,
                 "'" + text +
                     "' is not the address of a simulator; expected unix:/path/of/socket or "
                     "tcp://host:port"};
}

std::string to_string(const Endpoint& endpoint) {
  if (const auto* path = std::get_if<std::filesystem::path>(&endpoint)) {
    return std::string(kUnix) + path->string();
  }
  return std::string(kTcp) + link::to_string(std::get<link::Address>(endpoint));
}

}  // namespace tether::sim::protocol
