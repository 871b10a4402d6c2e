#include "gazebo_master.h"

#include <array>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string_view>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <ifaddrs.h>
#include <netinet/in.h>
#include <unistd.h>

#include <tether/base/error.h>
#include <tether/link/channel.h>

namespace tether::sim {

namespace {

/// The HOST of http://HOST:PORT.
std::optional<std::string> host_of(const std::string& uri) {
  constexpr std::string_view kScheme = "http://";
  if (!uri.starts_with(kScheme)) return std::nullopt;
  const auto address = link::parse_address(uri.substr(kScheme.size()));
  if (!address || address->host.empty() || address->port == 0) return std::nullopt;
  return address->host;
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
                       : "which is not http://HOST:PORT"))
      .about("GAZEBO_MASTER_URI");
}

}  // namespace tether::sim
