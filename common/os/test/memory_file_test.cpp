#include <fstream>

#include <gtest/gtest.h>
#include <unistd.h>

#include <tether/os/file_descriptor.h>
#include <tether/os/text_file.h>

namespace tether::os {
namespace {

TEST(MemoryFile, HoldsItsContent) {
  const std::string text = std::string("with \0 and \n", 12) + std::string(1 << 17, 'x');
  EXPECT_EQ(MemoryFile(text).content(), text);
  EXPECT_EQ(MemoryFile().content(), "");
}

TEST(MemoryFile, IsReadFromItsBeginningAndWrittenThroughItsPath) {
  const MemoryFile file("text");
  char read_back[8] = {};
  EXPECT_EQ(read(file.descriptor(), read_back, sizeof read_back), 4);
  EXPECT_STREQ(read_back, "text");
  EXPECT_EQ(read_whole(file.path()), "text");
  std::ofstream(file.path(), std::ios::trunc) << "new";
  EXPECT_EQ(file.content(), "new");
}

}  // namespace
}  // namespace tether::os
