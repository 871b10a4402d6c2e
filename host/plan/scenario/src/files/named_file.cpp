#include "files/named_file.h"

#include <fmt/format.h>

#include <tether/os/child_process.h>

namespace tether::scenario {

namespace fs = std::filesystem;

fs::path named_file(const toml::Table& table, std::string_view key, ShippedKind kind) {
  const std::string given = table.text(key);
  const fs::path folder = fs::path(table.where().file).parent_path();
  const ShippedFiles shipped = ShippedFiles::of_program(os::own_file());
  try {
    if (const auto file = shipped.named(kind, given, folder)) return *file;
  } catch (const Error& error) {
    table.fail(key, fmt::format("names no {}: {}", to_text(kind), error.what()));
  }
  // A path that was right where the file was copied from.
  std::error_code ignored;
  const fs::path of_name =
      fs::path(given).filename() == "model.sdf" ? fs::path(given).parent_path() : fs::path(given);
  const std::string name = of_name.stem();
  if (!fs::exists(folder / given, ignored) &&
      fs::is_regular_file(shipped.file_of(kind, name), ignored))
    table.fail(
        key, fmt::format("names \"{}\" ({}), but there is no such file. To use the shipped "
                         "{}, write \"{}\".",
                         given, (folder / given).lexically_normal().string(), to_text(kind), name));
  return table.existing_file(key);
}

}  // namespace tether::scenario
