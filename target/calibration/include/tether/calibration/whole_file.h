#pragma once

#include <string>
#include <string_view>

#include <tether/base/result.h>

/// Output files, with failures as values instead of exceptions. Thread-safe for different paths.
namespace tether::calibration {

/// Checks, without writing, whether `write_whole` can write `path` now. Fails with kInvalid and one
/// line if its folder does not exist or is not writable, or if `path` is not a regular file.
Status check_writable(const std::string& path);

/// Writes all of `bytes` to `path` or leaves it unchanged (see os::write_file_atomically). Fails
/// with kInvalid and one line that names `path`.
Status write_whole(const std::string& path, std::string_view bytes);

}  // namespace tether::calibration
