#pragma once

#include <filesystem>
#include <set>
#include <string>

namespace tether::app {

/// Creates `out`, or if that is empty, the folder `name` next to the record.
/// @param drawings the names of the files that will be written
/// @param pattern matches (fnmatch) the names of all files that this command writes for any record
/// @throws Error(kUsage) if the folder has a file of another record, which would be mixed with this
///   one's; Error(kSetup).
std::filesystem::path make_output_folder(std::filesystem::path out,
                                         const std::filesystem::path& record, const char* name,
                                         const std::set<std::string>& drawings,
                                         const char* pattern);

}  // namespace tether::app
