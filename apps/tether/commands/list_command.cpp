#include "commands/commands.h"
#include "terminal/print.h"

#include <algorithm>
#include <cctype>
#include <string>

#include <fmt/format.h>

#include <tether/os/child_process.h>
#include <tether/scenario/shipped_files.h>

namespace tether::app {
namespace {

struct ListOptions {};

using scenario::ShippedFile;
using scenario::ShippedFiles;
using scenario::ShippedKind;

/// Prints the names and descriptions of the files that Tether ships.
int list_shipped(const ListOptions&, const std::stop_token&) {
  const auto shipped = ShippedFiles::of_program(os::own_file());
  const char* gap = "";
  for (int i = 0; i < scenario::kShippedKinds; ++i) {
    const auto kind = static_cast<ShippedKind>(i);
    const auto files = shipped.list(kind);
    std::size_t width = 0;
    for (const ShippedFile& file : files) width = std::max(width, file.name.size());
    fmt::print("{}{}s\n", gap, scenario::to_text(kind));
    for (const ShippedFile& file : files) {
      std::string text = file.description;
      if (!text.empty()) text.front() = static_cast<char>(std::toupper(text.front()));
      print(fmt::format("  {:<{}}  {}\n", file.name, width, text));
    }
    gap = "\n";
  }
  print(fmt::format(
      "\nThe files are in {}. Scenarios and campaigns can name them as listed here: world = "
      "\"room\". Copy a file to change it, and give the copy another name.\n",
      shipped.folder().string()));
  return 0;
}

Options list_rows(ListOptions&) {
  return {};
}

}  // namespace

Command list_command() {
  return make_command(
      "list", "List the scenarios, campaigns, worlds, profiles and targets that Tether ships",
      list_rows,
      "You can pass these names to `tether run`, `tether campaign`, --profile and --target instead "
      "of a file.",
      list_shipped);
}

}  // namespace tether::app
