#pragma once

#include "fuzz_target.h"

#include <cstring>

#include <tether/link/socket.h>

namespace tether::fuzz {

/// Cuts the rest of the input into frames as it would come from a socket, in pieces whose sizes the
/// input chooses, and gives each whole frame to `check`.
template <class Check>
void for_each_frame(Choices& choices, std::uint32_t limit, Check check) {
  const std::size_t piece = 1 + choices.byte() * std::size_t{8};
  link::FrameBuffer buffer(limit);
  while (true) {
    const auto frame = buffer.next();
    const auto* bytes = value_or_refused(frame, {Failure::Kind::kProtocol});
    if (bytes == nullptr) return;
    if (!bytes->empty()) {
      check(*bytes);
      continue;
    }
    if (choices.empty()) return;
    const auto space = buffer.space();
    const Bytes came = choices.take(std::min(piece, space.size()));
    std::memcpy(space.data(), came.data(), came.size());
    buffer.commit(came.size());
  }
}

}  // namespace tether::fuzz
