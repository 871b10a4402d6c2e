#pragma once

#include <filesystem>
#include <string_view>

#include <tether/scenario/shipped_files.h>
#include <tether/toml/table.h>

namespace tether::scenario {

/// The existing file that a key names: by a path relative to the table's file, or, of a file that
/// Tether ships, by its name (ShippedFiles::named). Absolute.
/// @throws Error(kBadFile) about the key.
std::filesystem::path named_file(const toml::Table& table, std::string_view key, ShippedKind kind);

}  // namespace tether::scenario
