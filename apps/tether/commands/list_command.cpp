#include "commands/commands.h"
#include "terminal/print.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>

#include <fmt/format.h>

#include <tether/os/program.h>
#include <tether/scenario/shipped_files.h>

namespace tether::app {
namespace {

using scenario::ShippedFile;
using scenario::ShippedFiles;
using scenario::ShippedKind;

constexpr std::array kKinds = {ShippedKind::kScenario, ShippedKind::kCampaign, ShippedKind::kWorld,
                               ShippedKind::kProfile, ShippedKind::kTarget};

}  // namespace

int list_shipped(const ListOptions&, const std::stop_token&) {
  const auto shipped = ShippedFiles::of_program(os::own_file());
  const char* gap = "";
  for (const ShippedKind kind : kKinds) {
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
  print(fmt::format("\nThe files are in {}. Copy one to change it.\n", shipped.folder().string()));
  return 0;
}

}  // namespace tether::app
