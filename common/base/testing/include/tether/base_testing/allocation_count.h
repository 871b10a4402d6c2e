#pragma once

/// For tests of code that must not allocate.
namespace tether {

/// How often this program has asked for memory while the object lives, whoever asked: a test that
/// includes this has every call of malloc and its kin counted. One at a time; not thread-safe.
class AllocationCount {
 public:
  AllocationCount();
  ~AllocationCount();
  AllocationCount(const AllocationCount&) = delete;
  AllocationCount& operator=(const AllocationCount&) = delete;

  /// Ends the counting. Expectations allocate, so call it before them.
  long stop();
  /// Sanitizers bring an allocator of their own, of which nothing is counted.
  static bool is_possible();
};

}  // namespace tether
