#include <cerrno>
#include <cstdlib>
#include <system_error>

#include <tether/base/error.h>
#include <tether/base/system_reason.h>
#include <tether/os/temporary_folder.h>

namespace tether::os {
namespace {

/// $TMPDIR, else /tmp. `temp_directory_path` fails if $TMPDIR is not a folder.
std::filesystem::path usual_parent() {
  const char* given = std::getenv("TMPDIR");
  return given != nullptr && *given != '\0' ? given : "/tmp";
}

}  // namespace

TemporaryFolder::TemporaryFolder(const std::string& prefix)
    : TemporaryFolder(prefix, usual_parent()) {}

TemporaryFolder::TemporaryFolder(const std::string& prefix, const std::filesystem::path& parent) {
  std::string name = (parent / (prefix + "XXXXXX")).string();
  if (::mkdtemp(name.data()) == nullptr) {
    const std::string reason = "cannot be made: " + reason_of(errno);
    throw Error(ErrorCode::kSetup, {name},
                parent == usual_parent()
                    ? reason + ". Make space there, or set TMPDIR to another folder"
                    : reason);
  }
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace tether::os
