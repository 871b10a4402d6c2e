#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <new>
#include <string>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <tether/client/exec/clock_page.h>
#include <tether/os/machine.h>

namespace tether::client {
namespace {

constexpr std::size_t kPageBytes = sizeof(ClockPage);

#ifndef F_SEAL_FUTURE_WRITE
constexpr int F_SEAL_FUTURE_WRITE = 0x0010;  // Linux 5.1
#endif

Failure failed(const std::string& what) {
  return {Failure::Kind::kInvalid,
          "cannot share the memory of the clock: " + what + ": " + std::strerror(errno)};
}

}  // namespace

ExecTime ClockState::at(Duration mono) const {
  if (!running) return base_et;
  const Duration passed = std::max(mono - base_mono, Duration::zero());
  if (factor == 1.0) return base_et + passed;
  return base_et +
         Duration(static_cast<std::int64_t>(static_cast<double>(passed.count()) * factor));
}

Duration ClockState::mono_at(ExecTime et) const {
  const double left_ns = static_cast<double>((et - base_et).count()) / factor;
  // The longest wait.
  constexpr double kYear_ns = 365.0 * 24 * 3600 * 1e9;
  return base_mono + Duration(static_cast<std::int64_t>(std::ceil(std::min(left_ns, kYear_ns))));
}

void ClockPage::publish(const ClockState& state) {
  const std::uint32_t next = published_.load(std::memory_order_relaxed) + 1;
  Slot& slot = slots_[next % 2];
  slot.base_et_ns.store(to_ns(state.base_et), std::memory_order_release);
  slot.base_mono_ns.store(state.base_mono.count(), std::memory_order_release);
  slot.factor.store(state.factor, std::memory_order_release);
  slot.running.store(state.running, std::memory_order_release);
  published_.store(next, std::memory_order_release);
}

ClockState ClockPage::load(const Slot& slot) {
  ClockState state;
  state.base_et = from_ns<ExecTime>(slot.base_et_ns.load(std::memory_order_acquire));
  state.base_mono = Duration(slot.base_mono_ns.load(std::memory_order_acquire));
  state.factor = slot.factor.load(std::memory_order_acquire);
  state.running = slot.running.load(std::memory_order_acquire);
  return state;
}

ClockState ClockPage::state() const {
  return load(slots_[published_.load(std::memory_order_acquire) % 2]);
}

ExecTime ClockPage::now() const {
  return now(read_monotonic);
}

Duration read_monotonic() {
  return os::read_clock(CLOCK_MONOTONIC);
}

void SharedClockPage::Unmap::operator()(ClockPage* mapped) const {
  ::munmap(mapped, kPageBytes);
}
void MappedClockPage::Unmap::operator()(const ClockPage* mapped) const {
  ::munmap(const_cast<ClockPage*>(mapped), kPageBytes);
}

Result<SharedClockPage> make_clock_page() {
  os::FileDescriptor descriptor(::memfd_create("tether-clock", MFD_CLOEXEC | MFD_ALLOW_SEALING));
  if (!descriptor) return failed("memfd_create");
  if (::ftruncate(descriptor.get(), kPageBytes) != 0) return failed("ftruncate");
  void* const memory =
      ::mmap(nullptr, kPageBytes, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor.get(), 0);
  if (memory == MAP_FAILED) return failed("mmap");
  std::unique_ptr<ClockPage, SharedClockPage::Unmap> page(new (memory) ClockPage);
  const int sizes = F_SEAL_SHRINK | F_SEAL_GROW;
  // Kernels before 5.1 cannot prevent writes by others.
  if (::fcntl(descriptor.get(), F_ADD_SEALS, sizes | F_SEAL_FUTURE_WRITE) != 0 &&
      ::fcntl(descriptor.get(), F_ADD_SEALS, sizes) != 0) {
    return failed("F_ADD_SEALS");
  }
  return SharedClockPage{std::move(page), std::move(descriptor)};
}

Result<MappedClockPage> map_clock_page(const os::FileDescriptor& descriptor) {
  struct stat status {};
  if (::fstat(descriptor.get(), &status) != 0 || status.st_size != off_t{kPageBytes}) {
    return Failure{Failure::Kind::kProtocol,
                   "the clock page of tether-exec has another size. Use a tether-exec of the same "
                   "version as this program's library"};
  }
  void* const memory = ::mmap(nullptr, kPageBytes, PROT_READ, MAP_SHARED, descriptor.get(), 0);
  if (memory == MAP_FAILED) return failed("mmap");
  using Page = std::unique_ptr<const ClockPage, MappedClockPage::Unmap>;
  return MappedClockPage{Page(static_cast<const ClockPage*>(memory))};
}

}  // namespace tether::client
