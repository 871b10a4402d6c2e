#pragma once

#include <cstddef>
#include <cstring>
#include <exception>
#include <new>
#include <string_view>

#include <tether/base/result.h>
#include <tether/client.h>

namespace tether::c_api {

/// Keeps `message` as the calling thread's last error and returns `status`.
tether_status fail(tether_status status, std::string_view message) noexcept;
tether_status fail(const Failure& failure) noexcept;
tether_status to_c(Failure::Kind kind) noexcept;

/// TETHER_OK, or what `result` failed with.
template <class T>
tether_status status_of(const Result<T>& result) noexcept {
  return result ? TETHER_OK : fail(result.failure());
}

/// Whether each of the pointers is one; says so as the last error otherwise.
template <class... Pointers>
bool are_given(Pointers... pointers) noexcept {
  if ((... && (pointers != nullptr))) return true;
  fail(TETHER_INVALID, "an argument must not be NULL");
  return false;
}

/// Runs `body`, which returns a status: no exception leaves the library.
template <class Body>
tether_status guarded(Body&& body) noexcept {
  try {
    return body();
  } catch (const std::bad_alloc&) {
    return fail(TETHER_NO_MEMORY, "out of memory");
  } catch (const std::exception& e) {
    return fail(TETHER_INTERNAL, e.what());
  }
}

/// Size of a struct when it was first published: no caller knows less of it.
template <class T>
inline constexpr std::size_t kFirstSize = 0;
template <>
inline constexpr std::size_t kFirstSize<tether_camera_model> = 80;
template <>
inline constexpr std::size_t kFirstSize<tether_image_info> = 32;
// Samples that are a plain struct in C: the kind in the names of the struct and of functions, the
// type in C++, and the struct's first size. A row makes tether_read_KIND and tether_subscribe_KIND;
// to_c() of samples.h converts.
#define TETHER_SAMPLES(ROW)                 \
  ROW(imu, ImuSample, 96)                   \
  ROW(range, RangeSample, 24)               \
  ROW(navsat, NavSatSample, 96)             \
  ROW(magnetometer, MagnetometerSample, 40) \
  ROW(barometer, BarometerSample, 32)       \
  ROW(odometry, OdometrySample, 192)        \
  ROW(joint_state, JointStateSample, 56)
#define TETHER_FIRST_SIZE(kind, Sample, size) \
  template <>                                 \
  inline constexpr std::size_t kFirstSize<tether_##kind##_sample> = size;
TETHER_SAMPLES(TETHER_FIRST_SIZE)
#undef TETHER_FIRST_SIZE
template <>
inline constexpr std::size_t kFirstSize<tether_scan_model> = 64;
template <>
inline constexpr std::size_t kFirstSize<tether_scan_info> = 24;

/// Whether `out` can take a T of a caller who knows `size` bytes of it; clears it then.
template <class T>
bool can_take(T* out, std::size_t size) noexcept {
  if (!are_given(out)) return false;
  if (size < kFirstSize<T>) {
    fail(TETHER_INVALID, "the size of the struct is too small; pass sizeof *out");
    return false;
  }
  std::memset(out, 0, size);
  return true;
}

/// What the caller knows of `value`. @pre can_take()
template <class T>
void put(const T& value, T* out, std::size_t size) noexcept {
  std::memcpy(out, &value, size < sizeof value ? size : sizeof value);
}

}  // namespace tether::c_api
