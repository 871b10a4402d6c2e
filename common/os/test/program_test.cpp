#include <cstdlib>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/base_testing/thrown_error.h>
#include <tether/os/program.h>

namespace tether::os {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

/// With that for PATH, while it lives.
class Path {
 public:
  explicit Path(const std::string& path) { setenv("PATH", path.c_str(), 1); }
  ~Path() { setenv("PATH", before_.c_str(), 1); }
  Path(const Path&) = delete;
  Path& operator=(const Path&) = delete;

 private:
  std::string before_ = std::getenv("PATH");
};

fs::path make_program(const ScratchFolder& scratch, const std::string& name) {
  const fs::path file = scratch.write(name, "#!/bin/sh\n");
  fs::permissions(file, fs::perms::owner_exec, fs::perm_options::add);
  return file;
}

TEST(FindProgram, LooksBesideThisProgramFirst) {
  const ScratchFolder scratch;
  make_program(scratch, own_file().filename());
  const Path path(scratch.path());
  EXPECT_EQ(find_program(own_file().filename()), own_file());
}

TEST(FindProgram, LooksInTheFoldersOfPathInTheirOrder) {
  const ScratchFolder scratch;
  const fs::path first = make_program(scratch, "a/fly"), second = make_program(scratch, "b/fly");
  const Path path(scratch.path("none").string() + ":" + first.parent_path().string() + ":" +
                  second.parent_path().string());
  EXPECT_EQ(find_program("fly"), first);
  EXPECT_EQ(find_program(second), second);
}

TEST(FindProgram, RefusesWhatCannotBeExecuted) {
  const ScratchFolder scratch;
  const fs::path text = scratch.write("text", "no program");
  const Path path(scratch.path());
  EXPECT_THAT(error_message(ErrorCode::kSetup, [&] { find_program("text"); }),
              HasSubstr("it is neither in " + own_file().parent_path().string() + " nor in PATH"));
  EXPECT_THAT(error_message(ErrorCode::kSetup, [&] { find_program(text); }),
              HasSubstr("no such program, or not executable"));
}

}  // namespace
}  // namespace tether::os
