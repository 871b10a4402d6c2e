#include "iio/iio_folder.h"

#include "iio/iio_attribute.h"

#include <string_view>
#include <vector>

namespace tether::devices {
namespace {

constexpr std::string_view kPrefix = "iio:";

Result<std::string> by_path(System& system, const std::string& label, const std::string& path) {
  FileKind kind{};
  const int status = system.stat(path, kind);
  if (status < 0) {
    return invalid(label + ": " + error_text(-status) + "; `ls " + kIioRoot +
                   "` lists the sensors of the kernel");
  }
  if (kind != FileKind::kFolder) {
    return invalid(label + ": not a folder. Give one such as " + kIioRoot + "/iio:device0");
  }
  return path;
}

std::string joined(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : ", ") + part;
  return text;
}

Result<std::string> by_name(System& system, Clock& clock, const std::string& label,
                            const std::string& name, const std::string& root) {
  std::vector<std::string> matches;
  std::vector<std::string> seen;
  for (const std::string& entry : system.list(root)) {
    if (!entry.starts_with(kPrefix)) continue;
    const std::string folder = root + "/" + entry;
    if (entry == std::string(kPrefix) + name) return folder;
    const std::string driver_name = iio_name(system, clock, folder);
    if (driver_name == name) matches.push_back(folder);
    seen.push_back(entry + " (" + driver_name + ")");
  }
  if (matches.size() == 1) return matches.front();
  if (matches.size() > 1) {
    return invalid(label + ": several sensors have this name (" + joined(matches) +
                   "). Give the folder instead");
  }
  if (seen.empty()) {
    return invalid(label + ": the kernel has no sensor in " + root +
                   "; check that the sensor's driver is loaded");
  }
  return invalid(label + ": no sensor of this name in " + root + "; it has " + joined(seen));
}

}  // namespace

std::string iio_name(System& system, Clock& clock, const std::string& folder) {
  const Attribute file(system, folder + "/name");
  int error = 0;
  return file.error() != 0 ? std::string() : file.read_text(clock, error).value_or("");
}

Result<std::string> find_iio_folder(System& system, Clock& clock, const std::string& label,
                                    const std::string& device, const std::string& root) {
  // A folder below the present one may be called "iio:device0" too; write
  // "./iio:device0".
  if (!device.starts_with(kPrefix)) return by_path(system, label, device);
  return by_name(system, clock, label, device.substr(kPrefix.size()), root);
}

}  // namespace tether::devices
