#include "sut_script.h"

#include <cstddef>

#include <fmt/format.h>

#include <tether/os/child_process.h>

namespace tether::board {

namespace {

std::string joined(std::vector<std::string>::const_iterator begin,
                   std::vector<std::string>::const_iterator end) {
  std::string text;
  for (; begin != end; ++begin) text += " " + os::shell_word(*begin);
  return text;
}

}  // namespace

std::string assign(const std::string& name, const std::string& value) {
  return fmt::format("{}={}\n", name, os::shell_word(value));
}

std::string sut_prologue(const BoardSut& sut) {
  const auto program = sut.words.begin() + static_cast<std::ptrdiff_t>(sut.program);
  std::string text =
      assign("uav", sut.uav) + assign("program", *program) +
      assign("supervisor", sut.supervisor > 0 ? sut.words.front() : "") +
      assign("launcher", sut.program > sut.supervisor ? sut.words[sut.supervisor] : "");
  text += "join() {\n";
  for (const auto& [name, value] : sut.environment)
    text += fmt::format("{}={}\nexport {}\n", name, os::shell_word(value), name);
  text += fmt::format(
      "}}\nrun_sut() {{\n"
      "sh -c 'echo $$ >\"$0\" && exec setsid \"$@\"' \"$folder/pid.$uav\"{} \"$program\"{}\n}}\n",
      joined(sut.words.begin(), program), joined(program + 1, sut.words.end()));
  return text;
}

}  // namespace tether::board
