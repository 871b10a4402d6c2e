#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <sys/un.h>
#include <unistd.h>

#include <tether/client/exec/local_socket.h>
#include <tether/link/socket.h>

// Packets between a program and tether-exec. A frame of the link is one packet; a longer one is
// sent as a sealed memory file, whose descriptor travels in a packet with its length. The seals
// ensure that the sender cannot truncate the memory while the receiver maps it.
namespace tether::client {
namespace {

/// Frames up to this size fit a packet, and several of them the socket's buffer.
constexpr std::size_t kLongestInline = 16 * 1024;

// A packet with a descriptor says by these what that is; no frame begins like them.
constexpr std::array<std::uint8_t, 4> kFrameInMemory{0, 0, 0, 0};
constexpr std::array<std::uint8_t, 4> kClockPage{0xff, 0xff, 0xff, 0xff};

Failure lost(const std::string& why) {
  return {Failure::Kind::kDisconnected, "lost the connection to tether-exec: " + why};
}
Failure lost() {
  return lost(std::strerror(errno));
}
Failure broken(const std::string& why) {
  return {Failure::Kind::kProtocol,
          "protocol violation between the program and tether-exec: " + why};
}

/// Room for one descriptor.
struct alignas(cmsghdr) Control {
  std::array<char, CMSG_SPACE(sizeof(int))> bytes{};
};

os::FileDescriptor take_descriptor(msghdr& header) {
  const cmsghdr* const control = CMSG_FIRSTHDR(&header);
  if (control == nullptr || control->cmsg_type != SCM_RIGHTS) return os::FileDescriptor();
  int descriptor = -1;
  std::memcpy(&descriptor, CMSG_DATA(control), sizeof descriptor);
  return os::FileDescriptor(descriptor);
}

bool wait_readable(int descriptor, Duration timeout) {
  const Duration::rep ms = std::chrono::ceil<std::chrono::milliseconds>(timeout).count();
  pollfd entry{descriptor, POLLIN, 0};
  return link::uninterrupted([&] {
           return ::poll(&entry, 1, static_cast<int>(std::min<Duration::rep>(ms, 1'000'000'000)));
         }) != 0;
}

/// Decodes the frame in a sealed piece of memory, in place.
Result<link::Message> decode_memory(const os::FileDescriptor& memory) {
  struct stat status {};
  const int seals = ::fcntl(memory.get(), F_GET_SEALS);
  if (seals < 0 || (seals & F_SEAL_SHRINK) == 0 || ::fstat(memory.get(), &status) != 0) {
    return broken("the memory of a packet is not sealed");
  }
  const auto size = static_cast<std::size_t>(status.st_size);
  if (size < link::kFrameHeaderBytes || size > link::kMaxReplyBytes) return broken("bad length");
  void* const data = ::mmap(nullptr, size, PROT_READ, MAP_SHARED | MAP_POPULATE, memory.get(), 0);
  if (data == MAP_FAILED) return broken("the memory of a packet cannot be mapped");
  auto message = link::decode({static_cast<const std::uint8_t*>(data), size});
  ::munmap(data, size);
  return message;
}

Result<LocalSocket::Packet> understand(std::span<const std::uint8_t> bytes,
                                       os::FileDescriptor descriptor) {
  if (descriptor && std::equal(bytes.begin(), bytes.end(), kClockPage.begin(), kClockPage.end())) {
    return LocalSocket::Packet{std::nullopt, std::move(descriptor)};
  }
  auto message = descriptor ? decode_memory(descriptor) : link::decode(bytes);
  if (!message) return message.failure();
  return LocalSocket::Packet{std::move(*message), os::FileDescriptor()};
}

Result<sockaddr_un> address_of(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path) {
    return Failure{Failure::Kind::kInvalid, "the path of the socket is too long: " + path};
  }
  std::memcpy(address.sun_path, path.data(), path.size());
  return address;
}

os::FileDescriptor make_socket(int more_flags) {
  return os::FileDescriptor(::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | more_flags, 0));
}

/// Any socket address goes by this type through the system's calls.
const sockaddr* generic(const sockaddr_un& address) {
  return reinterpret_cast<const sockaddr*>(&address);
}

}  // namespace

Status LocalSocket::send(const link::Message& message) {
  if (Status valid = link::validate(message); !valid) return valid;
  const link::FramePieces pieces = encoder_.encode_pieces(message);
  if (pieces.size() > kLongestInline) return send_as_memory(pieces);
  packet_.clear();
  for (const auto piece : {pieces.head, pieces.image, pieces.tail}) {
    packet_.insert(packet_.end(), piece.begin(), piece.end());
  }
  return send_packet(packet_.data(), packet_.size(), -1);
}

Status LocalSocket::send_clock(const os::FileDescriptor& clock_page) {
  return send_packet(kClockPage.data(), kClockPage.size(), clock_page.get());
}

Status LocalSocket::send_as_memory(const link::FramePieces& pieces) {
  const os::FileDescriptor memory(::memfd_create("tether-frame", MFD_CLOEXEC | MFD_ALLOW_SEALING));
  if (!memory) return lost();
  for (const auto piece : {pieces.head, pieces.image, pieces.tail}) {
    for (std::size_t done = 0; done < piece.size();) {
      const ssize_t written = link::uninterrupted(
          [&] { return ::write(memory.get(), piece.data() + done, piece.size() - done); });
      if (written <= 0) return lost();
      done += static_cast<std::size_t>(written);
    }
  }
  if (::fcntl(memory.get(), F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_WRITE) != 0) {
    return lost();
  }
  return send_packet(kFrameInMemory.data(), kFrameInMemory.size(), memory.get());
}

Status LocalSocket::send_packet(const std::uint8_t* data, std::size_t bytes, int descriptor) {
  // iovec serves reading too and so points to non-const.
  iovec part{const_cast<std::uint8_t*>(data), bytes};
  msghdr header{};
  header.msg_iov = &part;
  header.msg_iovlen = 1;
  Control control;
  if (descriptor >= 0) {
    header.msg_control = control.bytes.data();
    header.msg_controllen = control.bytes.size();
    cmsghdr* const rights = CMSG_FIRSTHDR(&header);
    rights->cmsg_level = SOL_SOCKET;
    rights->cmsg_type = SCM_RIGHTS;
    rights->cmsg_len = CMSG_LEN(sizeof descriptor);
    std::memcpy(CMSG_DATA(rights), &descriptor, sizeof descriptor);
  }
  const ssize_t sent =
      link::uninterrupted([&] { return ::sendmsg(socket_.get(), &header, MSG_NOSIGNAL); });
  return sent < 0 ? Status(lost()) : ok_status();
}

Result<LocalSocket::Packet> LocalSocket::receive(std::optional<Duration> timeout) {
  if (timeout && !wait_readable(descriptor(), *timeout)) {
    return Failure{Failure::Kind::kTimeout, "timed out: no answer from tether-exec"};
  }
  input_.resize(kLongestInline);
  iovec part{input_.data(), input_.size()};
  Control control;
  msghdr header{};
  header.msg_iov = &part;
  header.msg_iovlen = 1;
  header.msg_control = control.bytes.data();
  header.msg_controllen = control.bytes.size();
  const ssize_t received =
      link::uninterrupted([&] { return ::recvmsg(socket_.get(), &header, MSG_CMSG_CLOEXEC); });
  if (received < 0 && errno == EAGAIN)
    return Failure{Failure::Kind::kTimeout, "no message is available"};
  if (received < 0) return lost();
  os::FileDescriptor descriptor = take_descriptor(header);
  if (received == 0) return lost("it was closed by the peer");
  if ((header.msg_flags & (MSG_TRUNC | MSG_CTRUNC)) != 0) return broken("a packet is too long");
  return understand({input_.data(), static_cast<std::size_t>(received)}, std::move(descriptor));
}

void LocalSocket::shut_down() {
  ::shutdown(descriptor(), SHUT_RDWR);
}

Result<LocalSocket> connect_local(const std::string& path) {
  const auto address = address_of(path);
  if (!address) return address.failure();
  os::FileDescriptor socket = make_socket(0);
  if (!socket || ::connect(socket.get(), generic(*address), sizeof *address) != 0) {
    return Failure{Failure::Kind::kDisconnected, "cannot connect to tether-exec at " + path + ": " +
                                                     std::strerror(errno) +
                                                     ". Check that it runs, and that TETHER_EXEC "
                                                     "is not left over from an earlier run"};
  }
  return LocalSocket(std::move(socket));
}

Result<os::FileDescriptor> listen_local(const std::string& path) {
  const auto address = address_of(path);
  if (!address) return address.failure();
  os::FileDescriptor socket = make_socket(SOCK_NONBLOCK);
  if (!socket || ::bind(socket.get(), generic(*address), sizeof *address) != 0 ||
      ::listen(socket.get(), SOMAXCONN) != 0) {
    return Failure{Failure::Kind::kInvalid,
                   "cannot listen at " + path + ": " + std::strerror(errno)};
  }
  return socket;
}

os::FileDescriptor accept_local(const os::FileDescriptor& listener) {
  return os::FileDescriptor(static_cast<int>(link::uninterrupted(
      [&] { return ::accept4(listener.get(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK); })));
}

}  // namespace tether::client
