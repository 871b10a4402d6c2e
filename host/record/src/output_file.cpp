#include "output_file.h"

#include "mcap_format.h"

#include <cerrno>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

#include <tether/base/error.h>

namespace tether::record {

OutputFile::OutputFile(std::filesystem::path path) : path_(std::move(path)) {
  descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (descriptor_ < 0) fail("cannot create the record", errno);
}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void OutputFile::write(std::string_view bytes) {
  crc_ = crc32(bytes, crc_);
  position_ += bytes.size();
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written >= 0) {
      bytes.remove_prefix(static_cast<std::size_t>(written));
    } else if (errno != EINTR) {
      fail("cannot write the record", errno);
    }
  }
}

// fsync fails with EINVAL on a pipe or a device, which have nothing to flush.
void OutputFile::close() {
  const int descriptor = std::exchange(descriptor_, -1);
  if (descriptor < 0) return;
  int why = 0;
  if (::fsync(descriptor) != 0 && errno != EINVAL) why = errno;
  if (::close(descriptor) != 0 && why == 0) why = errno;
  if (why != 0) fail("cannot finish the record", why);
}

void OutputFile::fail(const char* what, int error_number) {
  failed_ = true;
  throw Error(ErrorCode::kSetup, FileLocation{path_.string(), 0},
              std::string(what) + ": " + std::generic_category().message(error_number) +
                  ". Choose another folder with --out, or free some space");
}

}  // namespace tether::record
