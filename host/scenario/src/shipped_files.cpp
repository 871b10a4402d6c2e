#include <algorithm>
#include <array>

#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/base/suggest.h>
#include <tether/os/text_file.h>
#include <tether/scenario/shipped_files.h>
#include <tether/toml/table.h>

// Shipped files are found by the folder and the extension of their kind; each contains its own
// description.
namespace tether::scenario {
namespace {

namespace fs = std::filesystem;

struct Place {
  const char* name;
  const char* folder;
  const char* extension;
  const char* use;  ///< what to type before a file's name
};
constexpr std::array<Place, 5> kPlaces = {
    {{"scenario", "scenarios", ".toml", "tether run"},
     {"campaign", "campaigns", ".toml", "tether campaign"},
     {"world", "worlds", ".sdf", "tether world check"},
     {"profile", "profiles", ".toml", "tether run SCENARIO --profile"},
     {"target", "profiles/targets", ".toml", "tether run SCENARIO --target"}}};

const Place& place_of(ShippedKind kind) {
  return kPlaces.at(static_cast<std::size_t>(kind));
}

/// The first comment of an XML file up to its first full stop or colon.
std::string first_comment(const std::string& xml) {
  const std::size_t mark = xml.find("<!--");
  if (mark == std::string::npos) return {};
  std::string text;
  const std::size_t begin = std::min(xml.find_first_not_of(" \n", mark + 4), xml.size());
  for (std::size_t at = begin; at < xml.size(); ++at) {
    const char next = at + 1 < xml.size() ? xml[at + 1] : '\n';
    const bool is_end = (xml[at] == '.' || xml[at] == ':') && (next == ' ' || next == '\n');
    if (is_end || xml.compare(at, 3, "-->") == 0) break;
    const bool is_blank = xml[at] == ' ' || xml[at] == '\n';
    if (!is_blank)
      text += xml[at];
    else if (!text.ends_with(' '))
      text += ' ';
  }
  return text;
}

std::string description_of(const fs::path& file) {
  if (file.extension() == ".sdf") return first_comment(os::read_file(file, 1 << 20));
  const toml::Document document = toml::Document::load(file);
  return document.root().text_or("description", "");
}

}  // namespace

const char* to_text(ShippedKind kind) {
  return place_of(kind).name;
}

ShippedFiles ShippedFiles::of_program(const fs::path& program) {
  const fs::path bin = program.parent_path();
  const fs::path installed = bin.parent_path() / "share/tether";
  if (fs::is_directory(installed)) return ShippedFiles(installed);
  return ShippedFiles(bin.parent_path().parent_path().parent_path() / "data");
}

fs::path ShippedFiles::file_of(ShippedKind kind, const std::string& name) const {
  return data_ / place_of(kind).folder / (name + place_of(kind).extension);
}

std::vector<ShippedFile> ShippedFiles::list(ShippedKind kind) const {
  std::vector<ShippedFile> files;
  const fs::path folder = data_ / place_of(kind).folder;
  if (!fs::is_directory(folder)) return files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != place_of(kind).extension) continue;
    files.push_back({entry.path().stem(), description_of(entry.path())});
  }
  std::sort(files.begin(), files.end(),
            [](const ShippedFile& a, const ShippedFile& b) { return a.name < b.name; });
  return files;
}

fs::path ShippedFiles::find(ShippedKind kind, const std::string& given) const {
  const fs::path path = given;
  std::error_code ignored;
  if (fs::is_regular_file(path, ignored) || path.has_parent_path() || path.has_extension())
    return path;
  const fs::path shipped = file_of(kind, given);
  if (fs::is_regular_file(shipped, ignored)) return shipped;
  for (std::size_t i = 0; i < kPlaces.size(); ++i)
    if (fs::is_regular_file(file_of(static_cast<ShippedKind>(i), given), ignored))
      throw Error(ErrorCode::kUsage,
                  fmt::format("'{0}' is a shipped {1}, not a {2}. To use it, type: {3} {0}", given,
                              kPlaces[i].name, place_of(kind).name, kPlaces[i].use))
          .about(given);
  const auto files = list(kind);
  std::vector<std::string_view> names;
  for (const ShippedFile& file : files) names.push_back(file.name);
  const std::string_view near = nearest(given, names);
  throw Error(
      ErrorCode::kUsage,
      fmt::format("'{}' is neither a file nor a shipped {}{} `tether list` lists the "
                  "shipped files, which are in {}.",
                  given, place_of(kind).name,
                  near.empty() ? "." : fmt::format("; did you mean '{}'?", near), data_.string()))
      .about(given);
}

}  // namespace tether::scenario
