#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/base_testing/thrown_error.h>
#include <tether/os/text_file.h>

namespace tether::os {
namespace {

using testing::HasSubstr;

TEST(FileNameOf, LeadsNowhere) {
  EXPECT_EQ(file_name_of("uav-1_b.c"), "uav-1_b.c");
  EXPECT_EQ(file_name_of("../../etc/x"), ".._.._etc_x");
  EXPECT_EQ(file_name_of("a\nb\x1b[2J\x7f"), "a_b_[2J_");
}

TEST(WriteFileAtomically, ReplacesTheWholeFileAndLeavesNothingElse) {
  const ScratchFolder scratch;
  const auto file = scratch.path("a.json");
  write_file_atomically(file, "a longer first text");
  write_file_atomically(file, "second");
  EXPECT_EQ(read_file(file), "second");
  const auto entries = std::filesystem::directory_iterator(scratch.path());
  EXPECT_EQ(std::distance(begin(entries), end(entries)), 1);
}

TEST(WriteFileAtomically, ReplacesAPartThatACrashLeft) {
  const ScratchFolder scratch;
  scratch.write("a.json.part", "torn and longer than the new one");
  write_file_atomically(scratch.path("a.json"), "whole");
  EXPECT_EQ(read_file(scratch.path("a.json")), "whole");
  EXPECT_FALSE(std::filesystem::exists(scratch.path("a.json.part")));
}

TEST(WriteFileAtomically, NamesTheFileThatCannotBeWritten) {
  const ScratchFolder scratch;
  const std::string message = error_message(
      ErrorCode::kSetup, [&] { write_file_atomically(scratch.path("none/a.json"), "text"); });
  EXPECT_THAT(message, HasSubstr("none/a.json"));
  EXPECT_THAT(message, HasSubstr("No such file or directory"));
}

TEST(WriteFileAtomically, KeepsTheOldContentWhenItFails) {
  const ScratchFolder scratch;
  const auto file = scratch.write("a.json", "old");
  std::filesystem::create_directories(scratch.path("a.json.part"));
  error_message(ErrorCode::kSetup, [&] { write_file_atomically(file, "new"); });
  EXPECT_EQ(read_file(file), "old");
}

TEST(WriteFileAtomically, ReplacesTheFileBehindALinkAndNotTheLink) {
  const ScratchFolder scratch;
  const auto file = scratch.write("there/a.json", "old");
  const auto link = scratch.path("link.json"), link_to_link = scratch.path("second.json");
  std::filesystem::create_symlink("there/a.json", link);
  std::filesystem::create_symlink(link, link_to_link);
  write_file_atomically(link_to_link, "new");
  EXPECT_TRUE(std::filesystem::is_symlink(link));
  EXPECT_TRUE(std::filesystem::is_symlink(link_to_link));
  EXPECT_EQ(read_file(file), "new");
  std::filesystem::remove(file);
  write_file_atomically(link, "made");
  EXPECT_EQ(read_file(file), "made");
}

TEST(WriteFileAtomically, EndsALoopOfLinks) {
  const ScratchFolder scratch;
  std::filesystem::create_symlink("b", scratch.path("a"));
  std::filesystem::create_symlink("a", scratch.path("b"));
  EXPECT_THAT(
      error_message(ErrorCode::kSetup, [&] { write_file_atomically(scratch.path("a"), "text"); }),
      HasSubstr("cannot be followed"));
}

TEST(WriteFileAtomically, WritesIntoAPipeAlsoThroughALink) {
  const ScratchFolder scratch;
  const auto pipe = scratch.path("pipe"), link = scratch.path("link");
  std::filesystem::create_symlink(pipe, link);
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const int reader = open(pipe.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  write_file_atomically(pipe, "a ");
  write_file_atomically(link, "page");
  char text[16] = {};
  EXPECT_EQ(read(reader, text, sizeof text), 6);
  EXPECT_STREQ(text, "a page");
  EXPECT_EQ(std::filesystem::symlink_status(pipe).type(), std::filesystem::file_type::fifo);
  EXPECT_TRUE(std::filesystem::is_symlink(link));
  close(reader);
}

TEST(ReadFile, NamesAMissingFile) {
  const ScratchFolder scratch;
  EXPECT_THAT(error_message(ErrorCode::kBadFile, [&] { (void)read_file(scratch.path("none")); }),
              HasSubstr("no such file"));
}

// Values of the FNV reference (Fowler, Noll, Vo): fnv1a_64 of "" and of "foobar".
TEST(DigestOfFile, IsFnv1a) {
  const ScratchFolder scratch;
  EXPECT_EQ(digest_of_file(scratch.write("a", "")), "cbf29ce484222325");
  EXPECT_EQ(digest_of_file(scratch.write("b", "foobar")), "85944171f73967e8");
}

}  // namespace
}  // namespace tether::os
