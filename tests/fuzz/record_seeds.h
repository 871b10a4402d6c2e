#pragma once

#include <filesystem>

namespace tether::fuzz {

void write_record_seeds(const std::filesystem::path& folder);

}  // namespace tether::fuzz
