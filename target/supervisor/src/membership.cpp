#include "membership.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <utility>

#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <tether/os/file_descriptor.h>

namespace tether::supervisor {
namespace {

/// Of the words and the environment in memory, then those of Command.
constexpr std::size_t kDescriptors = 5;
constexpr std::size_t kLongestMessage = 1000;

/// A message of one byte, with room for the descriptors.
struct Envelope {
  Envelope() {
    header.msg_iov = &part;
    header.msg_iovlen = 1;
    header.msg_control = control.data();
    header.msg_controllen = control.size();
  }
  Envelope(const Envelope&) = delete;  // the header points into it
  Envelope& operator=(const Envelope&) = delete;

  char byte = 0;
  iovec part{&byte, 1};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(kDescriptors * sizeof(int))> control{};
  msghdr header{};
};

Failure lost() {
  return {Failure::Kind::kDisconnected,
          std::string("lost the connection within tether-exec: ") + std::strerror(errno)};
}

/// The UAV, the number of words, the words, and the environment, each with a 0 byte at its end.
std::string packed(const std::string& uav, const std::vector<std::string>& words) {
  std::string text = uav + '\0' + std::to_string(words.size()) + '\0';
  for (const std::string& word : words) text += word + '\0';
  for (char** variable = environ; *variable != nullptr; ++variable)
    text += std::string(*variable) + '\0';
  return text;
}

std::vector<std::string> parts_of(const std::string& text) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0, end = 0; begin < text.size(); begin = end + 1) {
    end = std::min(text.find('\0', begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
  }
  return parts;
}

std::string content_of(int file) {
  std::string text;
  char piece[4096];
  for (ssize_t size = 0;
       (size = ::pread(file, piece, sizeof piece, static_cast<off_t>(text.size()))) > 0;)
    text.append(piece, static_cast<std::size_t>(size));
  return text;
}

Result<Program> unpacked(const std::string& text) {
  const Failure broken{Failure::Kind::kProtocol, "a member of the group has sent no command"};
  std::vector<std::string> parts = parts_of(text);
  if (parts.size() < 3) return broken;
  const std::size_t words = std::strtoul(parts[1].c_str(), nullptr, 10);
  if (words == 0 || words > parts.size() - 2) return broken;
  const auto first = parts.begin() + 2, last = first + static_cast<std::ptrdiff_t>(words);
  Program program;
  program.uav = parts[0];
  program.command.words.assign(first, last);
  program.command.environment.emplace(last, parts.end());
  return program;
}

}  // namespace

Status send_program(int socket, const std::string& uav, const std::vector<std::string>& words) try {
  const os::MemoryFile memory(packed(uav, words));
  const os::FileDescriptor folder(::open(".", O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  const std::array<int, kDescriptors> descriptors{memory.descriptor(), folder.get(), STDIN_FILENO,
                                                  STDOUT_FILENO, STDERR_FILENO};
  Envelope envelope;
  cmsghdr* const rights = CMSG_FIRSTHDR(&envelope.header);
  rights->cmsg_level = SOL_SOCKET;
  rights->cmsg_type = SCM_RIGHTS;
  rights->cmsg_len = CMSG_LEN(sizeof descriptors);
  std::memcpy(CMSG_DATA(rights), descriptors.data(), sizeof descriptors);
  if (::sendmsg(socket, &envelope.header, MSG_NOSIGNAL) < 0) return lost();
  return ok_status();
} catch (const std::exception& error) {  // no memory
  return Failure{Failure::Kind::kDisconnected, error.what()};
}

Result<Program> receive_program(int socket) {
  Envelope envelope;
  const ssize_t size = ::recvmsg(socket, &envelope.header, MSG_DONTWAIT | MSG_CMSG_CLOEXEC);
  if (size < 0 && errno == EAGAIN)
    return Failure{Failure::Kind::kTimeout, "the member has not sent its command yet"};
  if (size <= 0) return lost();
  const cmsghdr* const rights = CMSG_FIRSTHDR(&envelope.header);
  if (rights == nullptr || rights->cmsg_type != SCM_RIGHTS ||
      rights->cmsg_len != CMSG_LEN(kDescriptors * sizeof(int)))
    return Failure{Failure::Kind::kProtocol, "a member of the group has sent no descriptors"};
  std::array<int, kDescriptors> descriptors{};
  std::memcpy(descriptors.data(), CMSG_DATA(rights), sizeof descriptors);
  const os::FileDescriptor memory(descriptors[0]);
  std::array<os::FileDescriptor, 4> own;
  for (std::size_t i = 0; i < own.size(); ++i) own[i] = os::FileDescriptor(descriptors[i + 1]);
  auto program = unpacked(content_of(memory.get()));
  if (!program) return program;
  for (std::size_t i = 0; i < own.size(); ++i) program->command.descriptors[i] = own[i].get();
  program->descriptors = std::move(own);
  return program;
}

void send_end(int socket, const CommandEnd& end) {
  std::string packet(sizeof end.code, '\0');
  std::memcpy(packet.data(), &end.code, sizeof end.code);
  packet += end.message.substr(0, kLongestMessage);
  static_cast<void>(!::send(socket, packet.data(), packet.size(), MSG_NOSIGNAL));
}

std::optional<CommandEnd> receive_end(int socket) {
  char packet[sizeof(int) + kLongestMessage];
  const ssize_t size = ::recv(socket, packet, sizeof packet, 0);
  if (size < static_cast<ssize_t>(sizeof(int))) return std::nullopt;
  CommandEnd end;
  std::memcpy(&end.code, packet, sizeof end.code);
  end.message.assign(packet + sizeof end.code, packet + size);
  return end;
}

void send_signal(int socket, int signal) {
  static_cast<void>(!::send(socket, &signal, sizeof signal, MSG_NOSIGNAL));
}

std::optional<int> receive_signal(int socket) {
  int signal = 0;
  const ssize_t size = ::recv(socket, &signal, sizeof signal, MSG_DONTWAIT);
  if (size == static_cast<ssize_t>(sizeof signal)) return signal;
  if (size < 0 && (errno == EAGAIN || errno == EINTR)) return 0;
  return std::nullopt;
}

}  // namespace tether::supervisor
