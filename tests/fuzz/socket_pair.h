#pragma once

#include "fuzz_target.h"

#include <fcntl.h>
#include <sys/socket.h>

#include <tether/link/socket.h>

namespace tether::fuzz {

/// A connection to a peer that has said all that it ever says: `said`, then it closed its half.
/// Nobody waits for anything on either end.
class SpokenFor {
 public:
  explicit SpokenFor(Bytes said) {
    int ends[2];
    require(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) == 0, "no socket pair");
    ours_ = link::Descriptor(ends[0]);
    peer_ = link::Descriptor(ends[1]);
    ::fcntl(peer_.get(), F_SETFL, O_NONBLOCK);
    while (!said.empty()) {
      const ssize_t sent = ::send(peer_.get(), said.data(), said.size(), MSG_NOSIGNAL);
      if (sent <= 0) break;  // more than a socket holds: it comes no further
      said = said.subspan(static_cast<std::size_t>(sent));
    }
    ::shutdown(peer_.get(), SHUT_WR);
  }

  /// The end of the product's. Once.
  link::Descriptor take_ours() { return std::move(ours_); }
  /// The peer reads what it was sent, so that sending never blocks.
  void read_all() {
    std::uint8_t bytes[4096];
    while (::recv(peer_.get(), bytes, sizeof bytes, 0) > 0) {
    }
  }

 private:
  link::Descriptor ours_;
  link::Descriptor peer_;
};

}  // namespace tether::fuzz
