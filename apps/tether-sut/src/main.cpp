#include "command_line.h"
#include "commands.h"

#include <exception>
#include <iostream>

namespace tether::sut {
namespace {

int run(int argc, char** argv) {
  const auto parsed = parse_command_line(argc, argv);
  if (const auto* refused = std::get_if<Refusal>(&parsed)) {
    (refused->exit_code == 0 ? std::cout : std::cerr) << refused->text;
    return refused->exit_code;
  }
  return run_command(std::get<CommandLine>(parsed), {std::cout, std::cerr});
}

}  // namespace
}  // namespace tether::sut

int main(int argc, char** argv) {
  try {
    return tether::sut::run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "tether-sut: " << error.what() << '\n';
    return 3;
  }
}
