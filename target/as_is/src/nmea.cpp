#include "nmea.h"

#include <cmath>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <numbers>

namespace tether::as_is {
namespace {

constexpr double kKnotsPerMetre = 3600.0 / 1852.0;

__attribute__((format(printf, 1, 2))) std::string text(const char* format, ...) {
  char line[128];
  va_list values;
  va_start(values, format);
  std::vsnprintf(line, sizeof line, format, values);
  va_end(values);
  return line;
}

/// "$GNGGA,…*5C": the checksum is of what is between $ and *.
std::string sentence(const std::string& words) {
  unsigned sum = 0;
  for (const char c : words) sum ^= static_cast<unsigned char>(c);
  return "$" + words + text("*%02X\r\n", sum);
}

/// "4723.8650000,N": degrees and minutes. Rounded as a whole, so that there are no 60 minutes.
std::string angle(double angle_deg, int digits, char positive, char negative) {
  constexpr std::int64_t kPerMinute = 10'000'000;
  const auto all = static_cast<std::int64_t>(std::llround(std::abs(angle_deg) * 60.0 * kPerMinute));
  const std::int64_t minutes = all / kPerMinute;
  return text("%0*lld%02lld.%07lld,%c", digits, static_cast<long long>(minutes / 60),
              static_cast<long long>(minutes % 60), static_cast<long long>(all % kPerMinute),
              std::signbit(angle_deg) ? negative : positive);
}

}  // namespace

std::string nmea_of(const uav::NavSatSample& sample, Duration at_utc) {
  using std::chrono::floor;
  const std::int64_t ms = floor<std::chrono::milliseconds>(at_utc).count();
  const std::time_t seconds = ms / 1000;
  std::tm utc{};
  ::gmtime_r(&seconds, &utc);
  const std::string time =
      text("%02d%02d%02d.%03d", utc.tm_hour, utc.tm_min, utc.tm_sec, static_cast<int>(ms % 1000));
  const std::string date = text("%02d%02d%02d", utc.tm_mday, utc.tm_mon + 1, utc.tm_year % 100);
  if (!sample.has_fix)
    return sentence("GNGGA," + time + ",,,,,0,00,99.99,,,,,,") +
           sentence("GNRMC," + time + ",V,,,,,,," + date + ",,,N") +
           sentence("GNGST," + time + ",,,,,,,");
  const std::string place =
      angle(sample.latitude_deg, 2, 'N', 'S') + "," + angle(sample.longitude_deg, 3, 'E', 'W');
  const uav::Vec3& v_m_s = sample.velocity_ENU_m_s;
  const double course_deg =
      std::fmod(std::atan2(v_m_s.x, v_m_s.y) * 180.0 / std::numbers::pi + 360.0, 360.0);
  return sentence("GNGGA," + time + "," + place +
                  text(",1,12,1.00,%.3f,M,0.0,M,,", sample.altitude_m)) +
         sentence("GNRMC," + time + ",A," + place +
                  text(",%.3f,%.2f,", std::hypot(v_m_s.x, v_m_s.y) * kKnotsPerMetre, course_deg) +
                  date + ",,,A") +
         sentence("GNGST," + time +
                  text(",,,,,%.3f,%.3f,%.3f", sample.horizontal_accuracy_m,
                       sample.horizontal_accuracy_m, sample.vertical_accuracy_m));
}

}  // namespace tether::as_is
