#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace tether::os {

/// Ends the name of a file that is being written, or was when the machine or the process stopped.
inline constexpr std::string_view kPartSuffix = ".part";

/// A name that a record or a peer gave as part of a file's name: '_' stands for what would lead out
/// of the folder or into a terminal ('/', control characters).
std::string file_name_of(std::string_view name);

/// Replaces `path` by `text`, whole or not at all: written beside it, flushed to the disk, renamed.
/// A symbolic link stays one, and the file behind it is replaced. What exists and is no regular
/// file (a pipe, a device) is written to directly.
/// @throws Error(kSetup) naming the file when the file system refuses; the old content stays.
void write_file_atomically(const std::filesystem::path& path, std::string_view text);

/// @throws Error(kBadFile) when it is missing or unreadable.
std::string read_file(const std::filesystem::path& file);

/// The whole file; empty where there is none.
std::string read_whole(const std::filesystem::path& file);
/// The last line that is not blank, without what is around it; empty: none.
std::string last_line(const std::string& text);

/// A 64-bit FNV-1a digest of the content as 16 hexadecimal digits: tells versions apart, proves
/// nothing.
/// @throws Error(kBadFile) as `read_file`.
std::string digest_of_file(const std::filesystem::path& file);

}  // namespace tether::os
