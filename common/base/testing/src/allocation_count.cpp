#include <atomic>
#include <cstddef>

#include <malloc.h>

#include <tether/base_testing/allocation_count.h>
#include <tether/base_testing/sanitizer.h>

namespace {

std::atomic<bool> counting = false;
std::atomic<long> allocations = 0;

[[maybe_unused]] void count() {
  if (counting) ++allocations;
}

}  // namespace

#if !TETHER_ADDRESS_SANITIZER && !TETHER_THREAD_SANITIZER
// All allocations of a program and its libraries call one of these.
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* old, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) {
  count();
  return __libc_malloc(size);
}
void* calloc(std::size_t number, std::size_t size) {
  count();
  return __libc_calloc(number, size);
}
void* realloc(void* old, std::size_t size) {
  count();
  return __libc_realloc(old, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  count();
  return __libc_memalign(alignment, size);
}
}
#endif

namespace tether {

AllocationCount::AllocationCount() {
  allocations = 0;
  counting = true;
}

AllocationCount::~AllocationCount() {
  counting = false;
}

long AllocationCount::stop() {
  counting = false;
  return allocations;
}

bool AllocationCount::is_possible() {
  return !TETHER_ADDRESS_SANITIZER && !TETHER_THREAD_SANITIZER;
}

}  // namespace tether
