#include "options/junit_option.h"

#include "options/output_file.h"
#include "terminal/say.h"

#include <system_error>

#include <tether/base/error.h>
#include <tether/os/text_file.h>
#include <tether/report/junit.h>

namespace tether::app {

int with_junit(const std::filesystem::path& file, const std::string& suite,
               const std::function<int()>& action) {
  if (file.empty()) return action();
  require_output_file("--junit", file, OutputFormat::kJunit);
  std::error_code ignored;  // writing reports it
  if (file.has_parent_path() && std::filesystem::create_directories(file.parent_path(), ignored))
    say("tether: --junit creates the folder {}\n", file.parent_path().string());
  const auto write = [&](const std::string& why) {
    os::write_file_atomically(file, report::junit_of_error(suite, why));
  };
  write("the command did not run to its end");
  try {
    return action();
  } catch (const Error& error) {
    write(error.what());
    throw;
  }
}

}  // namespace tether::app
