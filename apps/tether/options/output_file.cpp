#include "options/output_file.h"

#include "commands/size_options.h"
#include "options/refuse_option.h"
#include "reading/file_kind.h"

#include <algorithm>
#include <array>
#include <string_view>

#include <fmt/format.h>

#include <tether/campaign/campaign_folder.h>
#include <tether/campaign/result.h>
#include <tether/os/text_file.h>
#include <tether/runner/trial_folder.h>
#include <tether/timing/timing.h>

namespace tether::app {

namespace {

namespace fs = std::filesystem;

/// Other formats have no beginning of their own.
bool is_of_tether(const fs::path& file) {
  constexpr std::array<std::string_view, 4> kNames = {
      campaign::kResultFile, campaign::kCampaignFile, runner::kRecordFile, kSizeFile};
  return kind_of(file) || timing::is_timing_file(file) || file.extension() == ".toml" ||
         std::ranges::count(kNames, file.filename().string()) > 0;
}

struct Format {
  const char* name;
  bool (*is_kept)(const fs::path& file);  ///< whether it must not be replaced
};

bool is_no_junit(const fs::path& file) {
  constexpr std::size_t kProlog_bytes = 512;
  return os::begin_of(file, kProlog_bytes).find("<testsuites") == std::string::npos;
}
bool is_no_html(const fs::path& file) {
  constexpr std::string_view kBegin = "<!DOCTYPE html";
  return os::begin_of(file, kBegin.size()) != kBegin;
}
bool is_no_timing(const fs::path& file) {
  return !timing::is_timing_file(file);
}

constexpr std::array<Format, 5> kFormats = {{{"JUnit file", is_no_junit},
                                             {"HTML page", is_no_html},
                                             {"CSV file", is_of_tether},
                                             {"text report", is_of_tether},
                                             {"timing file", is_no_timing}}};

}  // namespace

void require_output_file(const std::string& option, const fs::path& file, OutputFormat format) {
  const auto& [name, is_kept] = kFormats.at(static_cast<std::size_t>(format));
  std::error_code none;
  if (fs::is_directory(file, none))
    refuse_option(option, fmt::format("{} is a folder. Name a file in it.", file.string()));
  if (fs::is_regular_file(file, none) && !fs::is_empty(file, none) && is_kept(file))
    refuse_option(option, fmt::format("{} exists and is no {}. Choose another name, or remove it.",
                                      file.string(), name));
}

}  // namespace tether::app
