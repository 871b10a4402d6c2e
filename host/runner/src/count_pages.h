#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <tether/os/child_process.h>
#include <tether/scenario/scenario.h>

/// Counting what the SUTs of a run compute, under an emulator with Tether's plugin.
namespace tether::runner {

/// The plugin: that of TETHER_COUNTER_PLUGIN, or beside this program, or as installed.
/// @throws Error(kSetup) with the package that has it.
std::filesystem::path find_counter_plugin();

/// The emulator's program. @throws Error(kSetup) with the package that has it.
std::filesystem::path find_emulator(const scenario::Emulator& emulator);

/// The pages of counts of a run's SUTs, one for each. They are in memory, and end with this object.
class CountPages {
 public:
  /// No pages, for other clocks.
  CountPages() = default;
  /// @throws Error(kSetup) if there is no memory, or no plugin.
  CountPages(const scenario::Emulator& emulator, std::size_t suts);
  ~CountPages();
  CountPages(CountPages&& other) noexcept;
  CountPages& operator=(CountPages&&) = delete;

  std::size_t size() const { return pages_.size(); }
  /// What the emulator and the client library of that SUT need.
  os::Environment environment(std::size_t sut) const;
  /// Grows as long as that SUT computes. Thread-safe.
  std::uint64_t work(std::size_t sut) const;

 private:
  struct Page;
  scenario::Emulator emulator_{};
  std::filesystem::path plugin_{};
  std::vector<Page> pages_{};
};

}  // namespace tether::runner
