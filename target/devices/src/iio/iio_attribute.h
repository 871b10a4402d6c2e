#pragma once

#include "clock.h"
#include "system.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tether::devices {

/// What reading a number gave: a finite value, or why there is none.
struct Reading {
  double value = 0.0;
  int error = 0;      ///< errno; 0 where there is none
  std::string fault;  ///< empty if there is a value; else it names the file

  bool ok() const { return fault.empty(); }
};

/// A file of the kernel's sysfs interface, kept open: reading it again from the beginning makes the
/// driver measure again, with one system call instead of three.
class Attribute {
 public:
  /// `path` is opened, not yet read. An `error()` other than 0 is why it could not be.
  Attribute(System& system, std::string path);

  const std::string& path() const { return path_; }
  int error() const { return error_; }

  /// The text without the newline at its end; none: errno is in `error`. EAGAIN and EINTR are tried
  /// again, for a second at most.
  std::optional<std::string> read_text(Clock& clock, int& error) const;
  Reading read(Clock& clock) const;

 private:
  std::string path_;
  Descriptor file_;
  int error_ = 0;
};

/// A decimal number that is all of the text, and finite.
std::optional<double> parse_number(std::string_view text);

/// "FILE: Device or resource busy; …", with what to do about it.
std::string iio_fault(const std::string& path, int error);

/// One quantity of an IIO device in SI units, by the kernel's ABI
/// (Documentation/ABI/testing/sysfs-bus-iio): BASE+AXIS+"_input" is the quantity itself; else it is
/// (BASE+AXIS+"_raw" + offset) × scale, where offset (0 if there is none) and scale (1) are the
/// axis' own or those of all axes. Both are read once, when the channel is opened.
class Channel {
 public:
  /// The channel "in_accel", "_x" of the device in `folder`. None: the device has no such channel.
  /// One that is there and cannot be read has a fault.
  static std::optional<Channel> open(System& system, Clock& clock, const std::string& folder,
                                     const std::string& base, const std::string& axis);

  const std::string& fault() const { return fault_; }
  /// Measures. @pre fault() is empty
  Reading read(Clock& clock) const;

 private:
  explicit Channel(Attribute value);
  void take_scale(System& system, Clock& clock, const std::string& folder, const std::string& base,
                  const std::string& axis);

  Attribute value_;
  double offset_ = 0.0;
  double scale_ = 1.0;
  std::string fault_;
};

}  // namespace tether::devices
