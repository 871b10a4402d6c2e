#pragma once

#include <filesystem>
#include <string>

#include <tether/base/error.h>

namespace tether::campaign {

/// @throws Error(kUsage) about the folder: results cannot be written there.
[[noreturn]] inline void refuse_folder(const std::filesystem::path& folder,
                                       const std::string& why) {
  throw Error(ErrorCode::kUsage, {folder.string()}, why).about(folder.string());
}

}  // namespace tether::campaign
