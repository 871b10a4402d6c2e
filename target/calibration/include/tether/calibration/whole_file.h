#pragma once

#include <string>
#include <string_view>

#include <tether/base/result.h>

/// Files that are there whole or not at all.
namespace tether::calibration {

/// Whether `write_whole` could write there now; leaves nothing behind. Fails (kInvalid) with one
/// line: the folder does not exist or cannot be written in, or the path is no regular file.
Status check_writable(const std::string& path);

/// Writes a temporary file in the same folder, flushes it to the disk and renames it, so that
/// `path` never names half of it; an interrupt (SIGINT, SIGTERM) meanwhile is ignored. Fails
/// (kInvalid) with one line, leaving nothing behind.
Status write_whole(const std::string& path, std::string_view bytes);

}  // namespace tether::calibration
