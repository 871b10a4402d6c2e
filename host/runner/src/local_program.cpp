#include "local_program.h"

#include "sut_environment.h"

#include <utility>

#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/os/program.h>

namespace tether::runner {

namespace {

bool is_bare(const std::string& program) {
  return program.find('/') == std::string::npos;
}

/// The program as a launcher takes it: by its whole path.
std::filesystem::path find_launched(const std::string& program, const scenario::Target& target) {
  std::error_code ignored;
  if (is_bare(program)) return os::find_program(program);
  if (std::filesystem::is_regular_file(program, ignored)) return program;
  throw Error(ErrorCode::kSetup, fmt::format("there is no program {}, which the target \"{}\" of "
                                             "{} is to run",
                                             program, target.name, target.file.string()));
}

}  // namespace

LocalSutCommand local_sut_command(const scenario::Sut& sut,
                                  const std::optional<scenario::Target>& target) {
  auto [words, program_at] = sut_command(sut, target);
  const bool is_launched = target && !target->launcher.empty();
  std::string& program = words[program_at];
  const auto file = is_launched ? find_launched(program, *target) : os::find_program(program);
  LocalSutCommand command{{}, {}};
  if (program_at > 0) {
    // Whoever starts it looks for it in PATH only.
    program = file.string();
    command.programs.push_back(os::find_program(words.front()));
    if (sut.concurrent && is_launched) command.programs.push_back(os::find_program(words[1]));
  }
  command.programs.push_back(file);
  command.words = std::move(words);
  return command;
}

std::vector<int> cpus_for(const std::vector<int>& allowed, int cores, std::size_t index) {
  const std::size_t count = static_cast<std::size_t>(cores), end = index * count;
  if (end + count > allowed.size()) return {};
  return {allowed.rbegin() + static_cast<std::ptrdiff_t>(end),
          allowed.rbegin() + static_cast<std::ptrdiff_t>(end + count)};
}

}  // namespace tether::runner
