#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <optional>
#include <sstream>
#include <string_view>
#include <system_error>
#include <vector>

#include <elf.h>
#include <sys/stat.h>
#include <unistd.h>

#include <tether/base/error.h>
#include <tether/os/child_process.h>
#include <tether/os/text_file.h>

namespace tether::os {
namespace {

bool is_program(const std::filesystem::path& file) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(file, ignored) && access(file.c_str(), X_OK) == 0;
}

bool is_source(const std::filesystem::path& file) {
  constexpr std::string_view kExtensions[] = {".cpp", ".cc", ".c",  ".h",
                                              ".hpp", ".rs", ".go", ".java"};
  return std::ranges::count(kExtensions, file.extension().string()) > 0;
}

/// Beside this program, or in a folder of PATH; empty: in none.
std::filesystem::path found_by_name(const std::string& name) {
  std::vector<std::filesystem::path> folders{own_file().parent_path()};
  const char* path = std::getenv("PATH");
  std::istringstream list(path ? path : "");
  for (std::string folder; std::getline(list, folder, ':');) folders.emplace_back(folder);
  const auto found =
      std::ranges::find_if(folders, [&](const auto& folder) { return is_program(folder / name); });
  return found == folders.end() ? std::filesystem::path() : *found / name;
}

/// What to write in place of a command line in one word: of "/bin/fly fast", two words. Empty: it
/// is no command line.
std::string apart(const std::string& word) {
  std::error_code ignored;
  for (std::size_t blank = word.find(' '); blank != std::string::npos;
       blank = word.find(' ', blank + 1)) {
    const std::string program = word.substr(0, blank);
    const bool has_path = program.find('/') != std::string::npos;
    if (has_path ? std::filesystem::is_regular_file(program, ignored)
                 : !program.empty() && !found_by_name(program).empty())
      return "Write each argument apart: \"" + program + "\", \"" + word.substr(blank + 1) + "\"";
  }
  return "";
}

/// Why a path is not a program, and what to do.
std::string why_not(const std::filesystem::path& file) {
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) return "it is a folder. Name a program in it";
  if (std::filesystem::exists(file, ignored))
    return is_source(file) ? "it is source code. Build it, and name the program"
                           : "it is not executable. Type: chmod +x " + file.string();
  if (std::ranges::find(file, std::filesystem::path("~")) != file.end())
    return "'~' does not stand for your home folder here. Write the whole path";
  if (const std::string words = apart(file); !words.empty())
    return "there is no such file. " + words;
  return "there is no such file. Build it, or correct its path";
}

/// A script is a program only if its first line names one that exists.
void require_interpreter(const std::filesystem::path& script) {
  constexpr std::size_t kLongest = 256;  // of Linux
  const std::string begin = begin_of(script, kLongest);
  if (!begin.starts_with("#!")) return;
  std::string interpreter = begin.substr(2, begin.find('\n') - 2);
  interpreter.erase(0, interpreter.find_first_not_of(" \t"));
  interpreter = interpreter.substr(0, interpreter.find_first_of(" \t"));
  std::error_code ignored;
  if (interpreter.empty() || std::filesystem::exists(interpreter, ignored)) return;
  const bool is_of_windows = interpreter.ends_with('\r');
  throw Error(ErrorCode::kSetup, "cannot start \"" + script.string() +
                                     "\": its first line names the interpreter \"" + interpreter +
                                     "\", which does not exist. " +
                                     (is_of_windows ? "Save the file with the line ends of Unix"
                                                    : "Install it, or correct the line"))
      .about(script.string());
}

}  // namespace

std::filesystem::path own_file() {
  return std::filesystem::read_symlink("/proc/self/exe");
}

std::vector<std::string> own_arguments() {
  std::ifstream line("/proc/self/cmdline", std::ios::binary);
  std::vector<std::string> words;
  for (std::string word; std::getline(line, word, '\0');) words.push_back(word);
  if (!words.empty()) words.erase(words.begin());
  return words;
}

namespace {

std::filesystem::path find_file(const std::string& name) {
  if (name.find('/') != std::string::npos) {
    if (is_program(name)) return name;
    throw Error(ErrorCode::kSetup, "cannot start \"" + name + "\": " + why_not(name)).about(name);
  }
  if (std::filesystem::path found = found_by_name(name); !found.empty()) return found;
  const std::string words = apart(name);
  throw Error(ErrorCode::kSetup,
              "cannot start \"" + name + "\": it is neither in " +
                  own_file().parent_path().string() + " nor in PATH. " +
                  (words.empty() ? "Install it, or give its path, with a '/'" : words))
      .about(name);
}

}  // namespace

namespace {

struct ElfFacts {
  bool has_loader = false;
  bool is_of_go = false;
};

/// Whether notes name Go's compiler: each has three words (the sizes of name and text, a type), the
/// name and the text, which end at a multiple of four.
bool has_go_note(std::string_view notes) {
  constexpr std::string_view kGo("Go\0\0", 4);
  const auto padded = [](std::size_t size) { return (size + 3) / 4 * 4; };
  for (Elf64_Nhdr head; notes.size() >= sizeof head;) {
    std::memcpy(&head, notes.data(), sizeof head);
    notes.remove_prefix(sizeof head);
    if (notes.substr(0, head.n_namesz) == kGo) return true;
    notes.remove_prefix(std::min(notes.size(), padded(head.n_namesz) + padded(head.n_descsz)));
  }
  return false;
}

/// None: it is a script, damaged, or not of 64 bits.
std::optional<ElfFacts> elf_facts(const std::filesystem::path& file) {
  constexpr std::size_t kMostNotes = 65536;
  std::ifstream stream(file, std::ios::binary);
  const auto read = [&](std::uint64_t at, void* to, std::size_t size) {
    stream.seekg(static_cast<std::streamoff>(at))
        .read(static_cast<char*>(to), static_cast<std::streamsize>(size));
    return stream.good();
  };
  Elf64_Ehdr head;
  if (!read(0, &head, sizeof head) || std::memcmp(head.e_ident, ELFMAG, SELFMAG) != 0 ||
      head.e_ident[EI_CLASS] != ELFCLASS64)
    return std::nullopt;
  ElfFacts facts;
  for (std::size_t i = 0; i < head.e_phnum; ++i) {
    Elf64_Phdr part;
    if (!read(head.e_phoff + i * head.e_phentsize, &part, sizeof part)) return std::nullopt;
    if (part.p_type == PT_INTERP) facts.has_loader = true;
    if (part.p_type != PT_NOTE || part.p_filesz > kMostNotes) continue;
    std::string notes(part.p_filesz, '\0');
    if (!read(part.p_offset, notes.data(), notes.size())) return std::nullopt;
    facts.is_of_go = facts.is_of_go || has_go_note(notes);
  }
  return facts;
}

}  // namespace

void require_preloadable(const std::filesystem::path& program) {
  const auto refuse = [&](const std::string& why) {
    throw Error(ErrorCode::kSetup, "\"" + program.string() + "\" cannot fly as it is: " + why)
        .about(program.string());
  };
  struct stat status {};
  if (stat(program.c_str(), &status) == 0 && (status.st_mode & (S_ISUID | S_ISGID)) != 0)
    refuse("it is set-user-ID or set-group-ID, so no library can be preloaded. Type: chmod ug-s " +
           program.string());
  const auto facts = elf_facts(program);
  if (!facts) return;
  if (facts->is_of_go)
    refuse(
        "it is written in Go, which does not ask the C library for the time. Let it use Tether's "
        "C library");
  if (!facts->has_loader)
    refuse("it is linked statically, so no library can be preloaded. Link it dynamically");
}

std::filesystem::path find_program(const std::string& name) {
  std::filesystem::path file = find_file(name);
  require_interpreter(file);
  return file;
}

}  // namespace tether::os
