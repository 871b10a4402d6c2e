#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include <tether/base/count_page.h>
#include <tether/os/child_process.h>
#include <tether/os/file_descriptor.h>

/// A program under an emulator with Tether's plugin, which counts the program's work in a page.
namespace tether::os {

/// What runs the program, and what its work costs.
struct Emulator {
  std::string program;    ///< "qemu-x86_64" or "qemu-aarch64"
  std::string cpu_model;  ///< as for its option -cpu
  std::string sysroot;    ///< absolute; the folder of the program's libraries; empty: those of here
  /// In the order of WorkClass, in parts of kCostUnitsPerNs of a nanosecond.
  std::array<std::uint64_t, kWorkClasses> cost_units{};
};

/// The plugin: that of TETHER_COUNTER_PLUGIN, or beside this program, or as installed.
/// @throws Error(kSetup) with the package that has it.
std::filesystem::path find_counter_plugin();

/// The emulator's program. @throws Error(kSetup) with the package that has it.
std::filesystem::path find_emulator(const Emulator& emulator);

/// Emulators run programs of one processor, and no scripts. @throws Error(kSetup), about the
/// program.
void require_emulated(const Emulator& emulator, const std::filesystem::path& program);

/// Adds variables to the command of an emulated program, so that its stack begins at the same
/// address whatever its variables and arguments are: what functions of the C library do depends on
/// where in a page their operands are. They fill a whole number of blocks, almost always one.
/// @pre the command's first two arguments are the emulator and the program
void pad_start(ChildCommand& command);

struct UnmapCounts {
  void operator()(CountPage* page) const;
};
using MappedCounts = std::unique_ptr<CountPage, UnmapCounts>;
/// The page in that file; null if it cannot be mapped.
MappedCounts map_counts(const std::filesystem::path& file);

/// The page of one program, which ends with this object.
class CountFile {
 public:
  /// @throws Error(kSetup) if there is no memory, or no plugin.
  explicit CountFile(const Emulator& emulator);

  /// What the emulator and the client library in the program need.
  Environment environment() const;
  /// What the program's work has cost so far. Thread-safe.
  Duration computed() const;

 private:
  Emulator emulator_;
  std::filesystem::path plugin_ = find_counter_plugin();
  MemoryFile file_;
  MappedCounts page_;
};

}  // namespace tether::os
