#include "mcap/output_file.h"

#include "mcap/mcap_format.h"

#include <algorithm>
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
  write_at(position_, bytes);
  crc_ = crc32(bytes, crc_);
  position_ += bytes.size();
}

void OutputFile::write_ahead(std::string_view bytes) {
  write_at(position_, bytes);
}

void OutputFile::write_at(std::uint64_t position, std::string_view bytes) {
  if (failed()) fail("cannot write the record", error_);
  while (!bytes.empty()) {
    const ssize_t written =
        ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(position));
    if (written >= 0) {
      bytes.remove_prefix(static_cast<std::size_t>(written));
      position += static_cast<std::uint64_t>(written);
    } else if (errno != EINTR) {
      fail("cannot write the record", errno);
    }
  }
  end_ = std::max(end_, position);
}

// fsync fails with EINVAL on a pipe or a device, which have nothing to flush.
void OutputFile::close() {
  const int descriptor = std::exchange(descriptor_, -1);
  if (descriptor < 0) return;
  int why = 0;
  const auto size = static_cast<off_t>(position_);
  if (end_ > position_ && ::ftruncate(descriptor, size) != 0) why = errno;
  if (::fsync(descriptor) != 0 && errno != EINVAL && why == 0) why = errno;
  if (::close(descriptor) != 0 && why == 0) why = errno;
  if (why != 0) fail("cannot finish the record", why);
}

void OutputFile::fail(const char* what, int error_number) {
  error_ = error_number;
  // A failure of this one would add nothing: readers stop at the part that is not whole.
  [[maybe_unused]] const int ignored = ::ftruncate(descriptor_, static_cast<off_t>(whole_));
  throw Error(ErrorCode::kSetup, FileLocation{path_.string(), 0},
              std::string(what) + ": " + std::generic_category().message(error_number) +
                  ". Choose another folder with --out, or free some space");
}

}  // namespace tether::record
