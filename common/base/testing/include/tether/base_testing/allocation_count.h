#pragma once

/// For tests of code that must not allocate.
namespace tether {

/// Counts all allocations of the program while the object lives: every call of malloc, calloc,
/// realloc and aligned_alloc in any thread. One object at a time; not thread-safe.
class AllocationCount {
 public:
  AllocationCount();
  ~AllocationCount();
  AllocationCount(const AllocationCount&) = delete;
  AllocationCount& operator=(const AllocationCount&) = delete;

  /// Ends the counting. Expectations allocate, so call it before them.
  long stop();
  /// False with sanitizers: their allocators are not counted.
  static bool is_possible();
};

}  // namespace tether
