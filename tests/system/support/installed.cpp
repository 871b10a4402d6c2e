#include "installed.h"

#include <stdexcept>

namespace tether::system_test {

std::string output_of(const std::vector<std::string>& arguments,
                      const std::vector<std::pair<std::string, std::string>>& environment,
                      const std::filesystem::path& working_folder) {
  const Output output = run({arguments, environment, working_folder}, std::chrono::seconds(100));
  if (output.code == 0) return output.out;
  throw std::runtime_error(arguments.front() + " ended with " + std::to_string(output.code) +
                           ":\n" + output.out + output.err);
}

void install_client(const std::filesystem::path& prefix) {
  for (const char* component : {"client", "client-dev"})
    output_of({TETHER_CMAKE, "--install", TETHER_BINARY_DIR, "--prefix", prefix, "--component",
               component});
}

std::filesystem::path folder_of(const std::filesystem::path& prefix, const std::string& file) {
  for (const auto& entry : std::filesystem::recursive_directory_iterator(prefix))
    if (entry.path().filename() == file) return entry.path().parent_path();
  throw std::runtime_error("no " + file + " below " + prefix.string());
}

}  // namespace tether::system_test
