#include <algorithm>
#include <array>
#include <sstream>

#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/base/text.h>
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
  const char* mark;  ///< a key that of all TOML files only those of this kind have
  const char* use;   ///< what to type before a file's name; null: it is named in a file
};
constexpr std::array<Place, kShippedKinds> kPlaces = {
    {{"scenario", "scenarios", ".toml", "world", "tether run"},
     {"campaign", "campaigns", ".toml", "scenario", "tether campaign"},
     {"mission", "missions", ".toml", "task", nullptr},
     {"world", "worlds", ".sdf", nullptr, "tether world check"},
     {"model", "models", "/model.sdf", nullptr, nullptr},
     {"profile", "profiles", ".toml", "sensors", "tether run SCENARIO --profile"},
     {"energy file", "energy", ".toml", "rotor", nullptr},
     {"target", "profiles/targets", ".toml", "clock", "tether run SCENARIO --target"},
     {"rig", "rigs", ".toml", "anchor", nullptr},
     {"engine", "engines", ".toml", "command", "tether campaign CAMPAIGN --engine"}}};

const Place& place_of(ShippedKind kind) {
  return kPlaces.at(static_cast<std::size_t>(kind));
}

std::string how_to_use(const Place& place, const std::string& name) {
  return place.use == nullptr ? "" : fmt::format(" To use it, type: {} {}.", place.use, name);
}

/// The text up to its first full stop or colon, on one line.
std::string first_sentence(const std::string& comment) {
  std::string text;
  const std::size_t begin = std::min(comment.find_first_not_of(" \n"), comment.size());
  for (std::size_t at = begin; at < comment.size(); ++at) {
    const char next = at + 1 < comment.size() ? comment[at + 1] : '\n';
    if ((comment[at] == '.' || comment[at] == ':') && (next == ' ' || next == '\n')) break;
    const bool is_blank = comment[at] == ' ' || comment[at] == '\n';
    if (!is_blank)
      text += comment[at];
    else if (!text.ends_with(' '))
      text += ' ';
  }
  return text;
}

std::string first_comment_of_xml(const std::string& xml) {
  const std::size_t mark = xml.find("<!--");
  if (mark == std::string::npos) return {};
  return xml.substr(mark + 4, xml.find("-->", mark) - mark - 4);
}

std::string first_comment_of_toml(const std::string& toml) {
  std::string comment;
  std::istringstream lines(toml);
  for (std::string line; std::getline(lines, line) && line.starts_with('#');)
    comment += line.substr(1) + "\n";
  return comment;
}

/// Whether a file that could be meant by a shipped file's name is of that kind.
bool is_of_kind(const fs::path& file, const Place& place) try {
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored)) return false;
  return place.mark == nullptr || toml::Document::load(file).root().has(place.mark);
} catch (const Error&) {
  return false;
}

std::string description_of(const fs::path& file) {
  const std::string text = os::read_file(file, 1 << 20);
  if (file.extension() == ".sdf") return first_sentence(first_comment_of_xml(text));
  const toml::Document document = toml::Document::parse(text, file);
  return document.root().has("description") ? document.root().text("description")
                                            : first_sentence(first_comment_of_toml(text));
}

}  // namespace

const char* to_text(ShippedKind kind) {
  return place_of(kind).name;
}

ShippedFiles ShippedFiles::of_program(const fs::path& program) {
  const fs::path installed = program.parent_path().parent_path() / "share/tether";
  if (fs::is_directory(installed)) return ShippedFiles(installed);
  fs::path folder = program.parent_path();
  while (folder.has_relative_path() && !fs::is_directory(folder / "data/scenarios"))
    folder = folder.parent_path();
  return ShippedFiles(folder / "data");
}

fs::path ShippedFiles::file_of(ShippedKind kind, const std::string& name) const {
  return data_ / place_of(kind).folder / (name + place_of(kind).extension);
}

std::string ShippedFiles::name_of(ShippedKind kind, const fs::path& file) const {
  std::error_code failed;
  return fs::equivalent(file_of(kind, file.stem().string()), file, failed) ? file.stem().string()
                                                                           : file.string();
}

bool ShippedFiles::has(ShippedKind kind, const std::string& name) const {
  std::error_code ignored;
  return fs::is_regular_file(file_of(kind, name), ignored);
}

std::vector<ShippedFile> ShippedFiles::list(ShippedKind kind) const {
  std::vector<ShippedFile> files;
  const fs::path folder = data_ / place_of(kind).folder;
  if (!fs::is_directory(folder)) return files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const fs::path file = file_of(kind, entry.path().stem());
    const bool is_one = entry.path() == file || entry.path() == file.parent_path();
    if (is_one && fs::is_regular_file(file))
      files.push_back({entry.path().stem(), description_of(file)});
  }
  std::sort(files.begin(), files.end(),
            [](const ShippedFile& a, const ShippedFile& b) { return a.name < b.name; });
  return files;
}

std::string ShippedFiles::why_none(ShippedKind kind, const std::string& given,
                                   const fs::path& folder) const {
  const Place& place = place_of(kind);
  if (const std::string other = what_is(given, fmt::format(", not a {}", place.name));
      !other.empty())
    return other;
  const std::string file = given + place.extension;
  std::error_code ignored;
  if (fs::is_regular_file(folder / file, ignored))
    return fmt::format("'{}' is no shipped {}. To use the file here, write '{}'.", given,
                       place.name, file);
  if (fs::is_directory(folder / given, ignored))
    return fmt::format("'{}' is a folder, not a {}.", given, place.name);
  const auto files = list(kind);
  std::vector<std::string_view> names;
  for (const ShippedFile& one : files) names.push_back(one.name);
  const std::string_view near = nearest(given, names);
  return fmt::format(
      "'{}' is neither a file nor a shipped {}{} `tether list` lists the shipped "
      "files, which are in {}.{}",
      given, place.name, near.empty() ? "." : fmt::format("; did you mean '{}'?", near),
      data_.string(),
      kind == ShippedKind::kTarget ? fmt::format(" A board is ssh://[user@]{}.", given) : "");
}

std::string ShippedFiles::what_is(const std::string& name, const std::string& but) const {
  for (std::size_t i = 0; i < kPlaces.size(); ++i)
    if (has(static_cast<ShippedKind>(i), name))
      return fmt::format("'{}' is a shipped {}{}.", name, kPlaces[i].name, but) +
             how_to_use(kPlaces[i], name);
  return "";
}

std::optional<fs::path> ShippedFiles::named(ShippedKind kind, const std::string& given,
                                            const fs::path& folder) const {
  const fs::path path = given;
  std::error_code ignored;
  if (fs::is_regular_file(folder / path, ignored) || path.has_parent_path() || path.has_extension())
    return std::nullopt;
  if (!has(kind, given)) throw Error(ErrorCode::kUsage, why_none(kind, given, folder)).about(given);
  const fs::path shipped = file_of(kind, given);
  for (const std::string& own :
       {given + place_of(kind).extension, given + shipped.extension().string()})
    if (is_of_kind(folder / own, place_of(kind)) && !fs::equivalent(folder / own, shipped, ignored))
      throw Error(
          ErrorCode::kUsage,
          fmt::format("'{0}' is a shipped {1}, but there is also the file '{2}' here. Write "
                      "'{2}' for this file, or rename it to use the shipped one.",
                      given, place_of(kind).name, own))
          .about(given);
  return shipped;
}

fs::path ShippedFiles::find(ShippedKind kind, const std::string& given) const {
  return named(kind, given, {}).value_or(given);
}

}  // namespace tether::scenario
