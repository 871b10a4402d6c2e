#include "gazebo_master.h"

#include <array>
#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string_view>
#include <system_error>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <ifaddrs.h>
#include <netinet/in.h>
#include <unistd.h>

#include <tether/base/error.h>

namespace tether::sim {

namespace {

/// The HOST of http://HOST:PORT.
std::optional<std::string> host_of(std::string_view uri) {
  constexpr std::string_view kScheme = "http://";
  const auto colon = uri.rfind(':');
  if (!uri.starts_with(kScheme) || colon <= kScheme.size()) return std::nullopt;
  const std::string_view port = uri.substr(colon + 1);
  std::uint16_t number = 0;
  const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), number);
  if (error != std::errc() || end != port.data() + port.size() || number == 0) return std::nullopt;
  return std::string(uri.substr(kScheme.size(), colon - kScheme.size()));
}

bool has_address(const std::string& host) {
  in_addr wanted{};
  if (inet_pton(AF_INET, host.c_str(), &wanted) != 1) return false;
  ifaddrs* list = nullptr;
  if (getifaddrs(&list) != 0) return false;
  const std::unique_ptr<ifaddrs, decltype(&freeifaddrs)> owner(list, freeifaddrs);
  for (const ifaddrs* own = list; own; own = own->ifa_next) {
    if (!own->ifa_addr || own->ifa_addr->sa_family != AF_INET) continue;
    const auto* address = reinterpret_cast<const sockaddr_in*>(own->ifa_addr);
    if (address->sin_addr.s_addr == wanted.s_addr) return true;
  }
  return false;
}

bool is_this_machine(const std::string& host) {
  std::array<char, 256> name{};
  const bool is_named = gethostname(name.data(), name.size() - 1) == 0 && host == name.data();
  return host == "localhost" || is_named || has_address(host);
}

}  // namespace

std::string master_of_user() {
  const char* given = std::getenv("GAZEBO_MASTER_URI");
  const std::string uri = given ? given : "";
  const auto host = host_of(uri);
  if (uri.empty() || (host && is_this_machine(*host))) return uri;
  throw Error(
      ErrorCode::kSetup,
      fmt::format("GAZEBO_MASTER_URI is \"{}\", {}; set http://localhost:PORT, or unset it", uri,
                  host ? "another machine, but gzserver is started on this one"
                       : "which is not http://HOST:PORT"));
}

}  // namespace tether::sim
