#include "local_program.h"

#include "child_process.h"
#include "sut_environment.h"

#include <fmt/format.h>

#include <tether/base/error.h>

namespace tether::app {

namespace {

bool is_bare(const std::string& program) {
  return program.find('/') == std::string::npos;
}

/// The program as a launcher takes it: by its whole path.
std::filesystem::path find_launched(const std::string& program, const scenario::Target& target) {
  std::error_code ignored;
  if (is_bare(program)) return find_program(program);
  if (std::filesystem::is_regular_file(program, ignored)) return program;
  throw Error(ErrorCode::kSetup, fmt::format("there is no program {}, which the target \"{}\" of "
                                             "{} is to run",
                                             program, target.name, target.file.string()));
}

}  // namespace

LocalSutCommand local_sut_command(const scenario::Sut& sut,
                                  const std::optional<scenario::Target>& target) {
  LocalSutCommand command{sut_command(sut, target), {}};
  const std::size_t launcher_words = target ? target->launcher.size() : 0;
  if (launcher_words > 0) {
    std::string& program = command.words[launcher_words];
    program = find_launched(program, *target).string();
    command.programs.emplace_back(program);
  }
  command.programs.insert(command.programs.begin(), find_program(command.words.front()));
  return command;
}

std::vector<int> cpus_for(const std::vector<int>& allowed, int cores, std::size_t index) {
  const std::size_t count = static_cast<std::size_t>(cores), end = index * count;
  if (end + count > allowed.size()) return {};
  return {allowed.rbegin() + static_cast<std::ptrdiff_t>(end),
          allowed.rbegin() + static_cast<std::ptrdiff_t>(end + count)};
}

}  // namespace tether::app
