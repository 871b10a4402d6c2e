#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>
#include <system_error>

#include <elf.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <tether/base/error.h>
#include <tether/os/child_process.h>
#include <tether/os/counted_program.h>
#include <tether/os/file_descriptor.h>
#include <tether/os/text_file.h>

namespace tether::os {

namespace {

constexpr const char* kPlugin = "libtether_count.so";

bool is_file(const std::filesystem::path& file) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(file, ignored);
}

}  // namespace

std::filesystem::path find_counter_plugin() {
  constexpr const char* kVariable = "TETHER_COUNTER_PLUGIN";
  if (const char* given = std::getenv(kVariable); given && *given) {
    if (is_file(given)) return std::filesystem::absolute(given);
    throw Error(ErrorCode::kSetup,
                std::string(kVariable) + " is " + given + ", which does not exist")
        .about(kVariable);
  }
  const auto prefix = own_file().parent_path().parent_path();
  for (const char* folder : {"lib", "lib/tether"})
    if (is_file(prefix / folder / kPlugin)) return prefix / folder / kPlugin;
  throw Error(ErrorCode::kSetup,
              std::string("Tether's plugin for emulators (") + kPlugin + ") was not found in " +
                  (prefix / "lib/tether").string() +
                  ". Install the package tether-counter, or the component of that name "
                  "(cmake --install)")
      .about(kPlugin);
}

std::filesystem::path find_emulator(const Emulator& emulator) try {
  return find_program(emulator.program);
} catch (const Error&) {
  throw Error(ErrorCode::kSetup, "the emulator " + emulator.program +
                                     " is not installed. Install the package qemu-user")
      .about(emulator.program);
}

void require_emulated(const Emulator& emulator, const std::filesystem::path& program) {
  constexpr std::size_t kMachineAt = offsetof(Elf64_Ehdr, e_machine);
  const std::string head = begin_of(program, kMachineAt + 1);
  const bool is_arm = emulator.program.ends_with("aarch64");
  const bool is_script = !head.starts_with(ELFMAG);
  if (!is_script && head.size() > kMachineAt &&
      static_cast<unsigned char>(head[kMachineAt]) == (is_arm ? EM_AARCH64 : EM_X86_64))
    return;
  throw Error(ErrorCode::kSetup,
              program.string() + " is " +
                  (is_script ? "a script, which " + emulator.program +
                                   " cannot run. Start its interpreter in 'command', by its "
                                   "path: [\"/usr/bin/python3\", \"SCRIPT\"]"
                             : "a program for another processor than that of " + emulator.program +
                                   ". Build it for " + (is_arm ? "64-bit ARM" : "x86-64") +
                                   ", or set another 'emulator' in the target file"))
      .about(program.string());
}

// Above its stack, a program has the texts of its variables and arguments, its own path, and an
// address for each text.
void pad_start(ChildCommand& command) {
  constexpr std::size_t kTexts = 128, kBytes = 32 * 1024;
  std::size_t texts = 0, bytes = command.arguments.at(1).size();
  const auto add = [&](std::size_t size) { ++texts, bytes += size + 1; };
  for (const auto& [name, value] : merged_environment(command.environment))
    add(name.size() + 1 + value.size());
  for (std::size_t i = 1; i < command.arguments.size(); ++i) add(command.arguments[i].size());
  const std::size_t first = command.environment.size();
  do {
    const std::string number = std::to_string(1000 + texts % kTexts);
    command.environment.emplace_back("TETHER_PADDING_" + number.substr(1), "");
    add(command.environment.back().first.size() + 1);
  } while (texts % kTexts != 0);
  command.environment[first].second.assign((kBytes - bytes % kBytes) % kBytes, '-');
}

void UnmapCounts::operator()(CountPage* page) const {
  ::munmap(page, sizeof(CountPage));
}

MappedCounts map_counts(const std::filesystem::path& file) {
  const FileDescriptor descriptor(::open(file.c_str(), O_RDWR | O_CLOEXEC));
  struct stat status {};
  if (!descriptor || ::fstat(descriptor.get(), &status) != 0) return nullptr;
  if (status.st_size < static_cast<off_t>(sizeof(CountPage))) return nullptr;
  void* const mapped =
      ::mmap(nullptr, sizeof(CountPage), PROT_READ | PROT_WRITE, MAP_SHARED, descriptor.get(), 0);
  return MappedCounts(mapped == MAP_FAILED ? nullptr : static_cast<CountPage*>(mapped));
}

CountFile::CountFile(const Emulator& emulator)
    : emulator_(emulator),
      file_(std::string(sizeof(CountPage), '\0')),
      page_(map_counts(file_.path())) {
  if (!page_) throw Error(ErrorCode::kSetup, "no memory for the counts of a program");
  new (page_.get()) CountPage{};
  page_->cost_units = emulator.cost_units;
}

// Of the same length for each process, so that the library in the program needs the same memory.
Environment CountFile::environment() const {
  const auto padded = [](int number) {
    const std::string digits = std::to_string(number);
    return std::string(10 - digits.size(), '/') + digits;
  };
  const std::string file = "/proc" + padded(::getpid()) + "/fd" + padded(file_.descriptor());
  Environment variables = {{"TETHER_COUNTS", file},
                           {"QEMU_PLUGIN", "file=" + plugin_.string() + ",page=" + file},
                           {"QEMU_CPU", emulator_.cpu_model}};
  if (!emulator_.sysroot.empty()) variables.emplace_back("QEMU_LD_PREFIX", emulator_.sysroot);
  return variables;
}

Duration CountFile::computed() const {
  const std::uint64_t units = page_->units.load();
  return Duration(static_cast<std::int64_t>(units / static_cast<std::uint64_t>(kCostUnitsPerNs)));
}

}  // namespace tether::os
