#include "command_line.h"
#include "commands.h"
#include "connection.h"

#include <exception>
#include <iostream>

namespace tether::sut {
namespace {

int run(int argc, char** argv) {
  auto parsed = parse_command_line(argc, argv);
  if (const auto* refused = std::get_if<Refusal>(&parsed)) {
    (refused->exit_code == 0 ? std::cout : std::cerr) << refused->text;
    return refused->exit_code;
  }
  auto& line = std::get<CommandLine>(parsed);
  if (line.only_checks) return 0;
  line.real_row.keep_image = in_run_folder(line.real_row.keep_image);
  if (line.characterize) line.characterize->out = in_run_folder(line.characterize->out);
  return run_command(line, {std::cout, std::cerr});
}

}  // namespace
}  // namespace tether::sut

int main(int argc, char** argv) {
  try {
    const int code = tether::sut::run(argc, argv);
    if (std::cout.flush()) return code;
    std::cerr << "tether-sut: standard output cannot be written\n";
    return 3;
  } catch (const std::exception& error) {
    std::cerr << "tether-sut: " << error.what() << '\n';
    return 3;
  }
}
