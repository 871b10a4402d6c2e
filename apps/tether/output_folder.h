#pragma once

#include <filesystem>

#include <tether/base/error.h>

namespace tether::app {

/// Creates `out`, or if that is empty, the folder `name` next to the record. @throws Error(kSetup).
inline std::filesystem::path make_output_folder(std::filesystem::path out,
                                                const std::filesystem::path& record,
                                                const char* name) {
  if (out.empty()) out = record.parent_path() / name;
  std::error_code error;
  std::filesystem::create_directories(out, error);
  if (error) throw Error(ErrorCode::kSetup, {out.string()}, error.message()).about(out.string());
  return out;
}

}  // namespace tether::app
