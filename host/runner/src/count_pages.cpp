#include "count_pages.h"

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <new>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <tether/base/count_page.h>
#include <tether/base/error.h>
#include <tether/base/system_reason.h>
#include <tether/os/program.h>

namespace tether::runner {

namespace {

constexpr const char* kPlugin = "libtether_count.so";

bool is_file(const std::filesystem::path& file) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(file, ignored);
}

}  // namespace

struct CountPages::Page {
  int descriptor = -1;
  CountPage* counts = nullptr;
};

std::filesystem::path find_counter_plugin() {
  constexpr const char* kVariable = "TETHER_COUNTER_PLUGIN";
  if (const char* given = std::getenv(kVariable); given && *given) {
    if (is_file(given)) return std::filesystem::absolute(given);
    throw Error(ErrorCode::kSetup, fmt::format("{} is {}, which does not exist", kVariable, given))
        .about(kVariable);
  }
  const auto prefix = os::own_file().parent_path().parent_path();
  for (const char* folder : {"lib", "lib/tether"})
    if (is_file(prefix / folder / kPlugin)) return prefix / folder / kPlugin;
  throw Error(ErrorCode::kSetup,
              fmt::format("Tether's plugin for emulators ({}) was not found in {}. Install the "
                          "package tether-counter",
                          kPlugin, (prefix / "lib/tether").string()))
      .about(kPlugin);
}

std::filesystem::path find_emulator(const scenario::Emulator& emulator) try {
  return os::find_program(emulator.program);
} catch (const Error&) {
  throw Error(ErrorCode::kSetup,
              fmt::format("the emulator {} is not installed. Install the package qemu-user",
                          emulator.program))
      .about(emulator.program);
}

CountPages::CountPages(const scenario::Emulator& emulator, std::size_t suts)
    : emulator_(emulator), plugin_(find_counter_plugin()), pages_(suts) {
  for (Page& page : pages_) {
    page.descriptor = ::memfd_create("tether-counts", MFD_CLOEXEC);
    void* memory = MAP_FAILED;
    if (page.descriptor >= 0 && ::ftruncate(page.descriptor, sizeof(CountPage)) == 0)
      memory = ::mmap(nullptr, sizeof(CountPage), PROT_READ | PROT_WRITE, MAP_SHARED,
                      page.descriptor, 0);
    if (memory == MAP_FAILED)
      throw Error(ErrorCode::kSetup,
                  fmt::format("no memory for the counts of a SUT: {}", reason_of(errno)));
    page.counts = new (memory) CountPage{};
    page.counts->cost_units = emulator.cost_units;
  }
}

CountPages::CountPages(CountPages&& other) noexcept
    : emulator_(std::move(other.emulator_)),
      plugin_(std::move(other.plugin_)),
      pages_(std::exchange(other.pages_, {})) {}

CountPages::~CountPages() {
  for (const Page& page : pages_) {
    if (page.counts) ::munmap(page.counts, sizeof(CountPage));
    if (page.descriptor >= 0) ::close(page.descriptor);
  }
}

os::Environment CountPages::environment(std::size_t sut) const {
  const std::string file = fmt::format("/proc/{}/fd/{}", ::getpid(), pages_[sut].descriptor);
  os::Environment variables = {
      {"TETHER_COUNTS", file},
      {"QEMU_PLUGIN", fmt::format("file={},page={}", plugin_.string(), file)},
      {"QEMU_CPU", emulator_.cpu_model}};
  if (!emulator_.sysroot.empty()) variables.emplace_back("QEMU_LD_PREFIX", emulator_.sysroot);
  return variables;
}

std::uint64_t CountPages::work(std::size_t sut) const {
  std::uint64_t sum = 0;
  for (const auto& count : pages_[sut].counts->counts) sum += count.load(std::memory_order_relaxed);
  return sum;
}

}  // namespace tether::runner
