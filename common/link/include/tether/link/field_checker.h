#pragma once

#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include <tether/base/result.h>
#include <tether/base/time.h>
#include <tether/link/codec.h>
#include <tether/uav/math.h>

namespace tether::link {

/// Checks the fields of a message, one call per field, and keeps the first complaint. Not
/// thread-safe.
class FieldChecker {
 public:
  void require(bool holds, std::string_view field, std::string_view rule) {
    if (holds || !complaint_.empty()) return;
    complaint_ = where_ + std::string(field) + " " + std::string(rule);
  }
  void in(std::string where) { where_ = std::move(where); }
  void text(const std::string& value, std::size_t limit, std::string_view field) {
    require(value.size() <= limit, field, "is longer than " + std::to_string(limit) + " bytes");
    require(value.find('\0') == std::string::npos, field, "contains a NUL byte");
  }
  void finite(double value, std::string_view field) {
    require(std::isfinite(value), field, "is not a finite number");
  }
  void finite(const uav::Vec3& v, std::string_view field) {
    require(std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z), field, "is not finite");
  }
  void unit(const uav::Quat& q, std::string_view field) {
    const double squared_norm = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
    require(std::abs(squared_norm - 1.0) < 1e-3, field, "is not a unit quaternion");
  }
  void timestamp(std::int64_t ns, std::string_view field) {
    require(ns >= 0 && ns < kMaxTimestampNs, field, "is negative or beyond 146 years");
  }
  template <class Clock>
  void timestamp(std::chrono::time_point<Clock, Duration> t, std::string_view field) {
    timestamp(to_ns(t), field);
  }

  Status status() const {
    if (complaint_.empty()) return ok_status();
    return Failure{Failure::Kind::kInvalid, complaint_};
  }

 private:
  std::string where_;
  std::string complaint_;
};

}  // namespace tether::link
