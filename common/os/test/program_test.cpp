#include <cstdlib>
#include <cstring>
#include <string>

#include <elf.h>
#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/base_testing/thrown_error.h>
#include <tether/os/child_process.h>

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

/// A program of one part that is loaded, with a note of that name and, if it has one, a loader.
std::string elf_program(const std::string& note_name, bool has_loader) {
  Elf64_Ehdr head{};
  std::memcpy(head.e_ident, ELFMAG, SELFMAG);
  head.e_ident[EI_CLASS] = ELFCLASS64;
  head.e_phoff = sizeof head;
  head.e_phentsize = sizeof(Elf64_Phdr);
  head.e_phnum = 2;
  const Elf64_Nhdr note_head{4, 0, 4};
  std::string note(sizeof note_head, '\0');
  std::memcpy(note.data(), &note_head, sizeof note_head);
  note += note_name + std::string(4 - note_name.size(), '\0');
  Elf64_Phdr parts[2]{};
  parts[0].p_type = has_loader ? PT_INTERP : PT_LOAD;
  parts[1].p_type = PT_NOTE;
  parts[1].p_offset = sizeof head + sizeof parts;
  parts[1].p_filesz = note.size();
  std::string file(sizeof head + sizeof parts, '\0');
  std::memcpy(file.data(), &head, sizeof head);
  std::memcpy(file.data() + sizeof head, parts, sizeof parts);
  return file + note;
}

TEST(RequirePreloadable, RefusesProgramsWhoseTimeCannotBeSet) {
  const ScratchFolder scratch;
  require_preloadable(own_file());
  require_preloadable(make_program(scratch, "script"));
  require_preloadable(scratch.write("dynamic", elf_program("GNU", true)));
  require_preloadable(scratch.write("cut", elf_program("GNU", false).substr(0, 100)));
  const auto set_id = make_program(scratch, "set-id");
  fs::permissions(set_id, fs::perms::set_uid, fs::perm_options::add);
  const std::pair<fs::path, std::string> cases[] = {
      {scratch.write("static", elf_program("GNU", false)), "it is linked statically"},
      {scratch.write("go", elf_program("Go", true)), "it is written in Go"},
      {set_id, "chmod ug-s " + set_id.string()},
  };
  for (const auto& [file, why] : cases) {
    const Error error =
        thrown_error(ErrorCode::kSetup, [&, &program = file] { require_preloadable(program); });
    EXPECT_EQ(error.subject(), file);
    EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace tether::os
