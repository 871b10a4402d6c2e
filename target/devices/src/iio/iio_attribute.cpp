#include "iio/iio_attribute.h"

#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <utility>

namespace tether::devices {
namespace {

constexpr Duration kRetryFor = std::chrono::seconds(1);
constexpr Duration kRetryEvery = std::chrono::milliseconds(1);

std::string_view trim(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\n\r";
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

std::string advice(int error) {
  switch (error) {
    case ENOENT:
      return "check that the sensor's driver is loaded";
    case EACCES:
    case EPERM:
      return "this user cannot read it; run as root, or add a udev rule";
    case EBUSY:
      return "another program has enabled the device's buffer; stop it, or write 0 to "
             "buffer/enable";
    case ENODEV:
    case ENXIO:
      return "the device was removed; check its connection and its driver";
    default:
      return "check the wiring, and the driver's messages in `dmesg`";
  }
}

}  // namespace

std::string iio_fault(const std::string& path, int error) {
  return path + ": " + error_text(error) + "; " + advice(error);
}

std::optional<double> parse_number(std::string_view text) {
  text = trim(text);
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || rest != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

// ---- one file

Attribute::Attribute(System& system, std::string path) : path_(std::move(path)) {
  const int opened = system.open(path_, false);
  if (opened >= 0) {
    file_ = Descriptor(system, opened);
  } else {
    error_ = -opened;
  }
}

std::optional<std::string> Attribute::read_text(Clock& clock, int& error) const {
  std::array<char, 512> buffer{};
  const Duration give_up = clock.now() + kRetryFor;
  for (;;) {
    const long count = file_.system().read_again(file_.number(), buffer.data(), buffer.size());
    if (count >= 0) return std::string(trim({buffer.data(), static_cast<std::size_t>(count)}));
    error = static_cast<int>(-count);
    if ((error != EAGAIN && error != EINTR) || clock.now() >= give_up) return std::nullopt;
    clock.sleep_until(clock.now() + kRetryEvery);
  }
}

Reading Attribute::read(Clock& clock) const {
  int error = error_;
  if (error != 0) return {0.0, error, iio_fault(path_, error)};
  const std::optional<std::string> text = read_text(clock, error);
  if (!text) return {0.0, error, iio_fault(path_, error)};
  const std::optional<double> value = parse_number(*text);
  if (!value) return {0.0, 0, path_ + ": not a number (\"" + text->substr(0, 40) + "\")"};
  return {*value, 0, {}};
}

// ---- a quantity

Channel::Channel(Attribute value) : value_(std::move(value)) {
  if (value_.error() != 0) fault_ = iio_fault(value_.path(), value_.error());
}

std::optional<Channel> Channel::open(System& system, Clock& clock, const std::string& folder,
                                     const std::string& base, const std::string& axis) {
  const std::string stem = folder + "/" + base + axis;
  Attribute input(system, stem + "_input");
  if (input.error() != ENOENT) return Channel(std::move(input));
  Attribute raw(system, stem + "_raw");
  if (raw.error() == ENOENT) return std::nullopt;
  Channel channel(std::move(raw));
  if (channel.fault_.empty()) channel.take_scale(system, clock, folder, base, axis);
  return channel;
}

void Channel::take_scale(System& system, Clock& clock, const std::string& folder,
                         const std::string& base, const std::string& axis) {
  const auto take = [&](const std::string& what, double& number) {
    for (const std::string& stem : {base + axis, base}) {
      const Attribute attribute(system, folder + "/" + stem + what);
      if (attribute.error() == ENOENT) continue;
      const Reading reading = attribute.read(clock);
      if (!reading.ok()) fault_ = reading.fault;
      number = reading.value;
      return;
    }
  };
  take("_offset", offset_);
  take("_scale", scale_);
}

Reading Channel::read(Clock& clock) const {
  Reading reading = value_.read(clock);
  reading.value = (reading.value + offset_) * scale_;
  return reading;
}

}  // namespace tether::devices
