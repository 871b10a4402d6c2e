#include "mcap/output_file.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <tether/base_testing/scratch_folder.h>

namespace {

int flushes = 0;

}  // namespace

// Replaces the function of the C library, to count calls.
extern "C" int fsync(int descriptor) {
  ++flushes;
  return static_cast<int>(syscall(SYS_fsync, descriptor));
}

namespace tether::record {
namespace {

TEST(OutputFile, IsFlushedToTheDiskOnceWhenClosed) {
  const ScratchFolder folder;
  const std::filesystem::path path = folder.path("file");
  flushes = 0;
  OutputFile file(path);
  file.write("first, ");
  file.write("second");
  EXPECT_EQ(flushes, 0);
  file.close();
  EXPECT_EQ(flushes, 1);
  file.close();
  EXPECT_EQ(flushes, 1);
  std::ifstream stream(path);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(stream), {}), "first, second");
}

TEST(OutputFile, AcceptsADeviceThatCannotBeFlushed) {
  OutputFile file("/dev/null");
  file.write("gone");
  EXPECT_NO_THROW(file.close());
}

}  // namespace
}  // namespace tether::record
