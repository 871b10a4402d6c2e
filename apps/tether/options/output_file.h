#pragma once

#include <filesystem>
#include <string>

namespace tether::app {

/// What an option's file is written as.
enum class OutputFormat { kJunit, kHtml, kCsv, kText, kTiming };

/// Checks, before anything is written, that an option's file can be replaced: it is missing, empty,
/// a device, or a file that Tether may have written in that format. Of CSV and text, that is every
/// file that is not another file of Tether's. An empty path is no file.
/// @throws Error(kUsage), about the option.
void require_output_file(const std::string& option, const std::filesystem::path& file,
                         OutputFormat format);

}  // namespace tether::app
