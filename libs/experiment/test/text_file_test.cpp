#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/experiment/text_file.h>
#include <tether/experiment_testing/scratch.h>

namespace tether::experiment {
namespace {

using testing::HasSubstr;

TEST(WriteFileAtomically, ReplacesTheWholeFileAndLeavesNothingElse) {
  const Scratch scratch;
  const auto file = scratch.path("a.json");
  write_file_atomically(file, "a longer first text");
  write_file_atomically(file, "second");
  EXPECT_EQ(read_file(file), "second");
  const auto entries = std::filesystem::directory_iterator(scratch.path(""));
  EXPECT_EQ(std::distance(begin(entries), end(entries)), 1);
}

TEST(WriteFileAtomically, ReplacesAPartThatACrashLeft) {
  const Scratch scratch;
  scratch.write("a.json.part", "torn and longer than the new one");
  write_file_atomically(scratch.path("a.json"), "whole");
  EXPECT_EQ(read_file(scratch.path("a.json")), "whole");
  EXPECT_FALSE(std::filesystem::exists(scratch.path("a.json.part")));
}

TEST(WriteFileAtomically, NamesTheFileThatCannotBeWritten) {
  const Scratch scratch;
  const std::string message = error_message(
      ErrorCode::kSetup, [&] { write_file_atomically(scratch.path("none/a.json"), "text"); });
  EXPECT_THAT(message, HasSubstr("none/a.json"));
  EXPECT_THAT(message, HasSubstr("No such file or directory"));
}

TEST(WriteFileAtomically, KeepsTheOldContentWhenItFails) {
  const Scratch scratch;
  const auto file = scratch.write("a.json", "old");
  std::filesystem::create_directories(scratch.path("a.json.part"));
  error_message(ErrorCode::kSetup, [&] { write_file_atomically(file, "new"); });
  EXPECT_EQ(read_file(file), "old");
}

TEST(ReadFile, NamesAMissingFile) {
  const Scratch scratch;
  EXPECT_THAT(error_message(ErrorCode::kBadFile, [&] { (void)read_file(scratch.path("none")); }),
              HasSubstr("no such file"));
}

// Values of the FNV reference (Fowler, Noll, Vo): fnv1a_64 of "" and of "foobar".
TEST(DigestOfFile, IsFnv1a) {
  const Scratch scratch;
  EXPECT_EQ(digest_of_file(scratch.write("a", "")), "cbf29ce484222325");
  EXPECT_EQ(digest_of_file(scratch.write("b", "foobar")), "85944171f73967e8");
}

}  // namespace
}  // namespace tether::experiment
