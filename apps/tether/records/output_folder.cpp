#include "records/output_folder.h"

#include <fmt/format.h>
#include <fnmatch.h>

#include <tether/base/error.h>
#include <tether/campaign/folder_claim.h>

namespace tether::app {

namespace fs = std::filesystem;

fs::path make_output_folder(fs::path out, const fs::path& record, const char* name,
                            const std::set<std::string>& drawings, const char* pattern) {
  if (out.empty()) out = record.parent_path() / name;
  std::error_code error;
  if (fs::is_regular_file(out, error))
    campaign::refuse_folder(out, "is a file, not a folder. Choose another name with --out.");
  fs::create_directories(out, error);
  if (error) throw Error(ErrorCode::kSetup, {out.string()}, error.message()).about(out.string());
  for (const auto& entry : fs::directory_iterator(out, error)) {
    const std::string file = entry.path().filename().string();
    if (!drawings.contains(file) && fnmatch(pattern, file.c_str(), FNM_EXTMATCH) == 0)
      campaign::refuse_folder(
          out, fmt::format("has '{}' of another record. Remove it, or choose another folder "
                           "with --out.",
                           file));
  }
  return out;
}

}  // namespace tether::app
