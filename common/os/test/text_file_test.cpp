#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/base_testing/thrown_error.h>
#include <tether/os/text_file.h>

namespace tether::os {
namespace {

namespace fs = std::filesystem;

TEST(FileNameOf, HasNoSlashesAndControlCharacters) {
  EXPECT_EQ(file_name_of("uav-1_b.c"), "uav-1_b.c");
  EXPECT_EQ(file_name_of("../../etc/x"), ".._.._etc_x");
  EXPECT_EQ(file_name_of("a\nb\x1b[2J\x7f"), "a_b_[2J_");
}

TEST(LastLine, IsTheLastThatIsNotBlank) {
  EXPECT_EQ(last_line("first\n \tlast line \r\n\n  \n"), "last line");
  EXPECT_EQ(last_line(" \n"), "");
}

TEST(BeginOf, HasAtMostTheBytesOfAFileAndNothingOfOthers) {
  const ScratchFolder scratch;
  const auto file = scratch.write("a", "text");
  EXPECT_EQ(begin_of(file, 2), "te");
  EXPECT_EQ(begin_of(file, 9), "text");
  for (const fs::path& other : {scratch.path(), scratch.path("none"), fs::path("/dev/zero")})
    EXPECT_EQ(begin_of(other, 2), "") << other;
}

TEST(WriteFileAtomically, ReplacesTheWholeFileAndLeavesNothingElse) {
  const ScratchFolder scratch;
  const auto file = scratch.write("a.json", "a longer first text");
  scratch.write("a.json.part", "what a process wrote that was killed");
  write_file_atomically(file, "second");
  EXPECT_EQ(read_file(file), "second");
  const auto entries = fs::directory_iterator(scratch.path());
  EXPECT_EQ(std::distance(begin(entries), end(entries)), 1);
}

TEST(WriteFileAtomically, NamesTheFileAndKeepsItsContentWhenItFails) {
  const ScratchFolder scratch;
  const auto file = scratch.write("a.json", "old");
  fs::create_directories(scratch.path("a.json.part"));
  const Error error = thrown_error(ErrorCode::kSetup, [&] { write_file_atomically(file, "new"); });
  EXPECT_EQ(error.where().file, file);
  EXPECT_EQ(read_file(file), "old");
}

TEST(WriteFileAtomically, ReplacesTheFileBehindALinkAndNotTheLink) {
  const ScratchFolder scratch;
  const auto file = scratch.write("there/a.json", "old");
  const auto link = scratch.path("link.json"), link_to_link = scratch.path("second.json");
  fs::create_symlink("there/a.json", link);
  fs::create_symlink(link, link_to_link);
  write_file_atomically(link_to_link, "new");
  EXPECT_TRUE(fs::is_symlink(link) && fs::is_symlink(link_to_link));
  EXPECT_EQ(read_file(file), "new");
  fs::remove(file);
  write_file_atomically(link, "made");
  EXPECT_EQ(read_file(file), "made");

  const auto loop = scratch.path("a");
  fs::create_symlink("b", loop);
  fs::create_symlink("a", scratch.path("b"));
  thrown_error(ErrorCode::kSetup, [&] { write_file_atomically(loop, "text"); });
}

TEST(WriteFileAtomically, WritesIntoAPipeAlsoThroughALink) {
  const ScratchFolder scratch;
  const auto pipe = scratch.path("pipe"), link = scratch.path("link");
  fs::create_symlink(pipe, link);
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const int reader = open(pipe.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  write_file_atomically(pipe, "a ");
  write_file_atomically(link, "page");
  char text[16] = {};
  EXPECT_EQ(read(reader, text, sizeof text), 6);
  EXPECT_STREQ(text, "a page");
  EXPECT_TRUE(fs::is_fifo(pipe) && fs::is_symlink(link));
  close(reader);
}

TEST(ReadFile, NamesAMissingFile) {
  const ScratchFolder scratch;
  const auto file = scratch.path("none");
  EXPECT_EQ(bad_file_error([&] { (void)read_file(file); }).where().file, file);
}

TEST(WhyNoFile, SuggestsTheNearestNameInTheFolder) {
  const ScratchFolder scratch;
  scratch.write("hover.toml", "");
  EXPECT_NE(why_no_file(scratch.path("hovr.toml")).find("'hover.toml'"), std::string::npos);
  EXPECT_EQ(why_no_file(scratch.path("quux")).find('\''), std::string::npos);
  scratch.write("models/drone/model.sdf", "");
  EXPECT_NE(why_no_file(scratch.path("models/dron/model.sdf")).find("'drone'"), std::string::npos);
  EXPECT_NE(why_no_file(scratch.path("none/hovr.toml")).find("none'"), std::string::npos);
  EXPECT_NE(why_no_file(scratch.path("models")).find("a folder"), std::string::npos);
}

// Values of the FNV reference (Fowler, Noll, Vo): fnv1a_64 of "" and of "foobar".
TEST(DigestOfFile, IsFnv1a) {
  const ScratchFolder scratch;
  EXPECT_EQ(digest_of_file(scratch.write("a", "")), "cbf29ce484222325");
  EXPECT_EQ(digest_of_file(scratch.write("b", "foobar")), "85944171f73967e8");
}

TEST(DigestOfFile, ReadsAFileAgainOnlyAfterItChanged) {
  const auto bytes_read = [] {
    std::istringstream counters(read_whole("/proc/self/io"));
    std::string name;
    std::uintmax_t count = 0;
    counters >> name >> count;  // "rchar: N", the first line
    return count;
  };
  const fs::path old = "/bin/sh";
  const std::string digest = digest_of_file(old);
  const std::uintmax_t before = bytes_read();
  EXPECT_EQ(digest_of_file(old), digest);
  EXPECT_LT(bytes_read() - before, fs::file_size(old) / 2);

  const ScratchFolder scratch;
  const fs::path changed = scratch.write("a", "old");
  digest_of_file(changed);
  scratch.write("a", "new");  // as long, and maybe within a tick of the file system's clock
  EXPECT_EQ(digest_of_file(changed), digest_of_file(scratch.write("b", "new")));
}

}  // namespace
}  // namespace tether::os
