#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/base_testing/thrown_error.h>
#include <tether/os/program.h>

namespace tether::os {
namespace {

namespace fs = std::filesystem;

/// Sets PATH while it lives.
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

TEST(FindProgram, SearchesTheFolderOfThisProgramThenPathInOrder) {
  const ScratchFolder scratch;
  const fs::path first = make_program(scratch, "a/fly"), second = make_program(scratch, "b/fly");
  make_program(scratch, "a" / own_file().filename());
  const Path path(scratch.path("none").string() + ":" + first.parent_path().string() + ":" +
                  second.parent_path().string());
  EXPECT_EQ(find_program(own_file().filename()), own_file());
  EXPECT_EQ(find_program("fly"), first);
  EXPECT_EQ(find_program(second), second);
}

TEST(FindProgram, RefusesWhatCannotBeExecuted) {
  const ScratchFolder scratch;
  const std::string text = scratch.write("text", "no program");
  const Path path(scratch.path());
  for (const std::string& name : {std::string("text"), text})
    EXPECT_EQ(thrown_error(ErrorCode::kSetup, [&] { find_program(name); }).subject(), name);
  const auto advice = [](const fs::path& file) {
    return std::string(thrown_error(ErrorCode::kSetup, [&] { find_program(file); }).what());
  };
  EXPECT_NE(advice(text).find("chmod +x " + text), std::string::npos);
  for (const fs::path& file : {scratch.path("none"), scratch.path(".")})
    EXPECT_EQ(advice(file).find("chmod"), std::string::npos);
}

TEST(FindProgram, AdvisesByWhatIsWrongWithThePath) {
  const ScratchFolder scratch;
  const std::string folder = scratch.path();
  scratch.write("bad.cpp", "int main() {}\n");
  scratch.write("fly", "no program");
  for (const char* script : {"gone", "windows"}) make_program(scratch, script);
  scratch.write("gone", "#! /no/such/python3 -u\n");
  scratch.write("windows", "#!/bin/sh\r\necho\r\n");
  const std::pair<const char*, std::string> cases[] = {
      {"/bad.cpp", "it is source code. Build it, and name the program"},
      {"/fly fast now", "Write each argument apart: \"" + folder + "/fly\", \"fast now\""},
      {"/~/bin/fly", "'~' does not stand for your home folder here. Write the whole path"},
      {"/gone", "names the interpreter \"/no/such/python3\", which does not exist. Install it"},
      {"/windows", "Save the file with the line ends of Unix"},
  };
  for (const auto& [name, advice] : cases) {
    const std::string file = folder + name;
    const std::string message = thrown_error(ErrorCode::kSetup, [&] { find_program(file); }).what();
    EXPECT_NE(message.find(advice), std::string::npos) << message;
  }
  make_program(scratch, "tab");
  scratch.write("tab", "#!\t /bin/sh\t-e\n");
  EXPECT_EQ(find_program(folder + "/tab"), folder + "/tab");
}

}  // namespace
}  // namespace tether::os
