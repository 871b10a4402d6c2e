#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace tether::experiment {

/// Replaces `file` by `text`, whole or not at all: written beside it, flushed to the disk, renamed.
/// @throws Error(kSetup) naming the file when the file system refuses; the old content stays.
void write_file_atomically(const std::filesystem::path& file, std::string_view text);

/// @throws Error(kBadFile) when it is missing or unreadable.
std::string read_file(const std::filesystem::path& file);

/// A 64-bit FNV-1a digest of the content as 16 hexadecimal digits: tells versions apart, proves
/// nothing.
/// @throws Error(kBadFile) as `read_file`.
std::string digest_of_file(const std::filesystem::path& file);

}  // namespace tether::experiment
