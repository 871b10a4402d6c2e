#include "socket_connection.h"

#include <cerrno>
#include <cstring>
#include <optional>
#include <string>
#include <system_error>

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

namespace tether::sim::protocol {
namespace {

using link::Descriptor;

Failure failure(Failure::Kind kind, int error) {
  return {kind, std::system_category().message(error)};
}

std::optional<sockaddr_un> address_of(const std::filesystem::path& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string text = path.string();
  if (text.empty() || text.size() >= sizeof address.sun_path) return std::nullopt;
  std::memcpy(address.sun_path, text.data(), text.size());
  return address;
}

Failure too_long() {
  return {Failure::Kind::kInvalid, "the path of a socket must have 1 to " +
                                       std::to_string(sizeof(sockaddr_un::sun_path) - 1) +
                                       " bytes; choose a shorter one"};
}

Descriptor stream_socket() {
  return Descriptor(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
}

template <class Call>
int call_with(const Descriptor& socket, const sockaddr_un& address, Call call) {
  return call(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address);
}

/// Whether there is a socket without a listener, such as that of a simulator that crashed.
bool is_abandoned(const sockaddr_un& address) {
  struct stat status {};
  if (::lstat(address.sun_path, &status) != 0 || !S_ISSOCK(status.st_mode)) return false;
  const Descriptor probe = stream_socket();
  return call_with(probe, address, ::connect) != 0 && errno == ECONNREFUSED;
}

}  // namespace

Result<Descriptor> open_unix(const std::filesystem::path& path, Duration timeout) {
  const auto address = address_of(path);
  if (!address) return too_long();
  Descriptor socket = stream_socket();
  link::limit_sending(socket.get(), timeout);  // connecting as well
  if (call_with(socket, *address, ::connect) == 0) return socket;
  if (errno == EAGAIN) return Failure{Failure::Kind::kTimeout, "too many connections are waiting"};
  return failure(Failure::Kind::kDisconnected, errno);
}

Result<Descriptor> listen_on_unix(const std::filesystem::path& path) {
  const auto address = address_of(path);
  if (!address) return too_long();
  if (is_abandoned(*address)) ::unlink(address->sun_path);
  Descriptor socket = stream_socket();
  // The file gets the socket's mode, so that others can never connect.
  if (!socket.is_open() || ::fchmod(socket.get(), S_IRUSR | S_IWUSR) != 0 ||
      call_with(socket, *address, ::bind) != 0 || ::listen(socket.get(), SOMAXCONN) != 0) {
    return failure(Failure::Kind::kInvalid, errno);
  }
  return socket;
}

}  // namespace tether::sim::protocol
