#pragma once

#include <filesystem>

/// Questions about paths whose answer is "no" also for what cannot be a path, such as a name that
/// is too long.
namespace tether::sim {

inline bool is_folder(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::is_directory(path, ignored);
}
inline bool is_file(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(path, ignored);
}
inline bool is_there(const std::filesystem::path& path) {
  return is_file(path) || is_folder(path);
}

}  // namespace tether::sim
