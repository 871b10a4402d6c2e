#pragma once

#include <string>

#include <tether/base/error.h>

namespace tether::sim {

/// Calls `read` for a file that the world names at a place.
/// @throws Error(kBadFile) at that place, with the message and the subject of the one that `read`
/// throws; that one itself if there is no place.
template <class Read>
decltype(auto) read_named(const FileLocation& named_at, const Read& read) {
  try {
    return read();
  } catch (const Error& e) {
    if (e.code() != ErrorCode::kBadFile || named_at.file.empty()) throw;
    throw Error(ErrorCode::kBadFile, named_at,
                std::string("names a file that cannot be used: ") + e.what())
        .about(e.subject());
  }
}

}  // namespace tether::sim
