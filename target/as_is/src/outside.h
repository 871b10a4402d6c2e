#pragma once

#include <cstdint>
#include <span>

#include <sys/types.h>

namespace tether::as_is {

/// Who does what a process waits for.
enum class Who { kNobody, kInside, kOutside };  // of some processes

/// Whose socket listens for TCP at this port of this computer.
Who listens_at(std::uint16_t port, std::span<const pid_t> inside);
/// Who has a lock on the file, as by flock() or fcntl().
Who has_locked(int fd, std::span<const pid_t> inside);

}  // namespace tether::as_is
