// Reads one SDF file with libsdformat. tinyxml2 reads it first, for the lines of XML errors and of
// custom elements, and for `check_numbers`. libsdformat's typed errors and warnings are collected
// by its policies; its console is captured for those that version 12 reports only there.

#include "sdf_source.h"

#include "sdf_numbers.h"
#include "sdf_rules.h"

#include <algorithm>
#include <cstdlib>
#include <regex>
#include <sstream>
#include <stdexcept>

#include <console_bridge/console.h>
#include <tinyxml2.h>

namespace tether::sim {

namespace fs = std::filesystem;

namespace {

/// Keeps libsdformat and the URDF reader that it tries on broken files from writing to the console
/// while this lives, and holds what they would have written.
class QuietConsole {
 public:
  QuietConsole() : stream_(sdf::Console::Instance()->GetMsgStream().GetStream()) {
    sdf::Console::Instance()->GetMsgStream().SetStream(&text_);
    console_bridge::noOutputHandler();
  }
  ~QuietConsole() {
    sdf::Console::Instance()->GetMsgStream().SetStream(stream_);
    console_bridge::restorePreviousOutputHandler();
  }
  QuietConsole(const QuietConsole&) = delete;
  QuietConsole& operator=(const QuietConsole&) = delete;

  std::string text() const { return text_.str(); }

 private:
  std::ostream* stream_;
  std::ostringstream text_;
};

/// False also for what cannot be a path, such as a name that is too long.
bool is_folder(const fs::path& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored);
}
bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

void add_folders_of_variable(const char* variable, std::vector<fs::path>& folders) {
  const char* value = std::getenv(variable);
  std::istringstream list(value != nullptr ? value : "");
  for (std::string folder; std::getline(list, folder, ':');) {
    if (!folder.empty()) folders.emplace_back(folder);
  }
}

/// Where model:// leads: around the file first, then Gazebo's own variables.
std::vector<fs::path> model_folders(const fs::path& file) {
  const fs::path folder = file.parent_path();
  std::vector<fs::path> folders{folder / "models", folder.parent_path() / "models",
                                folder.parent_path(), folder};
  add_folders_of_variable("GAZEBO_MODEL_PATH", folders);
  add_folders_of_variable("GZ_SIM_RESOURCE_PATH", folders);
  return folders;
}

/// Longer messages of libsdformat, which may quote a whole file, are cut: std::regex needs stack
/// for every character.
constexpr std::size_t kLongestMessage = 2000;

/// One line, without trailing full stop.
std::string one_line(const std::string& text) {
  std::istringstream words(text.substr(0, kLongestMessage));
  std::string line;
  for (std::string word; words >> word;) line += (line.empty() ? "" : " ") + word;
  while (line.ends_with('.')) line.pop_back();
  return line;
}

/// What the value at the end of an XML path ("/sdf/.../link[@name="l"]/inertial/mass") must be, as
/// the end of a message; empty where it has no rule.
std::string allowed_value(const std::string& xml_path) {
  const std::size_t slash = xml_path.rfind('/');
  if (slash == std::string::npos) return "";
  std::string parent = xml_path.substr(0, slash);
  if (parent.ends_with(']')) parent.resize(std::min(parent.rfind("[@name="), parent.size()));
  parent.erase(0, parent.rfind('/') + 1);
  const ValueRule* rule = find_rule(parent, xml_path.substr(slash + 1));
  return rule != nullptr ? std::string("; ") + rule->allowed : "";
}

/// libsdformat continues after these.
bool is_warning(const sdf::Error& error) {
  return error.Code() == sdf::ErrorCode::ATTRIBUTE_INCORRECT_TYPE ||
         error.Code() == sdf::ErrorCode::ELEMENT_DEPRECATED;
}

sdf::ElementPtr find_named(const sdf::ElementPtr& element, const std::string& name) {
  if (name_attribute(element) == name) return element;
  sdf::ElementPtr found;
  for_each_child(element, [&](const sdf::ElementPtr& child) {
    if (!found) found = find_named(child, name);
  });
  return found;
}

/// Which of its same-named siblings of the same file this is.
int ordinal(const sdf::ElementPtr& element) {
  int count = 0;
  bool reached = false;
  for_each_child(element->GetParent(), [&](const sdf::ElementPtr& sibling) {
    reached = reached || sibling == element;
    if (!reached && sibling->GetName() == element->GetName() &&
        sibling->FilePath() == element->FilePath()) {
      ++count;
    }
  });
  return count;
}

const tinyxml2::XMLElement* nth_child(const tinyxml2::XMLElement* parent, const std::string& name,
                                      int n) {
  const tinyxml2::XMLElement* child = parent->FirstChildElement(name.c_str());
  for (; child != nullptr && n > 0; --n) child = child->NextSiblingElement(name.c_str());
  return child;
}

}  // namespace

std::string name_attribute(const sdf::ElementPtr& element) {
  const std::string name =
      element->HasAttribute("name") ? element->GetAttribute("name")->GetAsString() : "";
  return name == "__default__" ? "" : name;
}

std::string describe(const sdf::ElementPtr& element) {
  const auto named = [](const sdf::ElementPtr& e) {
    return e->GetName() + " '" + name_attribute(e) + "'";
  };
  if (!name_attribute(element).empty()) return named(element);
  for (sdf::ElementPtr parent = element->GetParent(); parent; parent = parent->GetParent()) {
    if (!name_attribute(parent).empty()) return "<" + element->GetName() + "> of " + named(parent);
  }
  return "<" + element->GetName() + ">";
}

void for_each_child(const sdf::ElementPtr& element,
                    const std::function<void(const sdf::ElementPtr&)>& visit) {
  if (!element) return;
  for (sdf::ElementPtr child = element->GetFirstElement(); child; child = child->GetNextElement()) {
    visit(child);
  }
}

SdfSource::~SdfSource() = default;

SdfSource::SdfSource(const fs::path& file) : file_(fs::absolute(file).lexically_normal()) {
  if (is_folder(file_)) {
    throw Error(ErrorCode::kBadFile, {file_.string(), 0},
                "is a directory; give the SDF file in it, such as model.sdf");
  }
  if (!is_file(file_)) {
    throw Error(ErrorCode::kBadFile, {file_.string(), 0}, "there is no such file");
  }
  model_folders_ = model_folders(file_);

  // XML first: libsdformat does not report the line of an XML error.
  const tinyxml2::XMLDocument* xml = xml_of(file_.string());
  if (xml->Error()) {
    require_a_handle_for(file_.string());
    throw Error(ErrorCode::kBadFile, {file_.string(), xml->ErrorLineNum()},
                "not well-formed XML (" + std::string(xml->ErrorName()) + ")");
  }
  if (xml->RootElement() == nullptr) {
    throw Error(ErrorCode::kBadFile, {file_.string(), 0},
                "has no element; the outermost element of an SDF file must be <sdf>");
  }
  if (std::string(xml->RootElement()->Name()) != "sdf") {
    throw Error(ErrorCode::kBadFile, {file_.string(), xml->RootElement()->GetLineNum()},
                "the outermost element is <" + std::string(xml->RootElement()->Name()) +
                    ">; it must be <sdf>");
  }
  check_numbers(file_.string(), *xml);
  parse();
  if (!root_.Element()) throw_first_error();
  check_included_numbers();
}

void SdfSource::check_included_numbers() const {
  for (const fs::path& file : files()) {
    if (file != file_) check_numbers(file.string(), *xml_of(file.string()));
  }
}

void SdfSource::parse() {
  sdf::ParserConfig config;
  // A prefix of every URI: a relative include means the file's folder, not the current one.
  config.AddURIPath("", file_.parent_path().string());
  for (const fs::path& folder : model_folders_) config.AddURIPath("model://", folder.string());
  config.SetFindCallback([](const std::string&) { return std::string(); });

  // As errors they have a place. The elements that SDF does not know are named by `check_elements`.
  config.SetWarningsPolicy(sdf::EnforcementPolicy::ERR);
  config.SetUnrecognizedElementsPolicy(sdf::EnforcementPolicy::LOG);

  QuietConsole console;
  try {
    errors_ = root_.Load(file_.string(), config);
  } catch (const std::logic_error& error) {
    // Of the file or of one that it includes; libsdformat does not say which.
    throw Error(ErrorCode::kBadFile, {file_.string(), 0},
                "libsdformat cannot read it (" + std::string(error.what()) +
                    "); check <sdf version='...'> here and in included files");
  }
  for (const sdf::Error& error : errors_)
    if (is_warning(error)) warnings_.push_back(located(where(error), one_line(error.Message())));
  std::erase_if(errors_, is_warning);
  collect_console(console.text());
}

/// What libsdformat 12 has no typed error for: the reason why it refuses a value, names that occur
/// twice, what it changed in a file of an older SDF, and warnings of included files.
void SdfSource::collect_console(const std::string& text) {
  constexpr std::string_view kRed = "\x1b[1;31m", kEndOfPrefix = "]\x1b[0m ";
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t end = line.find(kEndOfPrefix);
    if (end == std::string::npos) continue;
    const std::string message = one_line(line.substr(end + kEndOfPrefix.size()));
    if (line.starts_with(kRed))
      console_errors_.push_back(message);
    else
      warnings_.push_back(located({file_.string(), 0}, message));
  }
}

void SdfSource::throw_on_errors() const {
  if (!errors_.empty()) throw_first_error();
}

void SdfSource::throw_first_error() const {
  require_a_handle_for(file_.string());
  if (errors_.empty()) throw Error(ErrorCode::kBadFile, {file_.string(), 0}, "not an SDF file");
  const sdf::Error& first = errors_.front();
  std::string reason = one_line(first.Message());
  const bool is_value = first.Code() == sdf::ErrorCode::ELEMENT_INVALID && !root_.Element();
  if (is_value && !console_errors_.empty()) {
    reason += ": " + console_errors_.front() + allowed_value(first.XmlPath().value_or(""));
  }
  if (first.Code() == sdf::ErrorCode::LINK_INERTIA_INVALID) {
    reason += "; moments must be positive, and none larger than the sum of the other two";
  }
  if (first.Code() == sdf::ErrorCode::URI_LOOKUP) {
    reason +=
        "; model:// is searched for next to the file, in its models/ and ../models/, and in "
        "GAZEBO_MODEL_PATH";
  }
  throw Error(ErrorCode::kBadFile, where(first), reason);
}

FileLocation SdfSource::where(const sdf::Error& error) const {
  if (error.LineNumber()) {
    return {error.FilePath().value_or(file_.string()), *error.LineNumber()};
  }
  // Errors between elements carry names instead of lines: "name[x]", "A link named x".
  static const std::regex naming("name\\[([^\\]]*)\\]|named (\\S+)");
  const std::string message = error.Message().substr(0, kLongestMessage);
  for (std::sregex_iterator it(message.begin(), message.end(), naming), end; it != end; ++it) {
    const std::string name = (*it)[1].matched ? (*it)[1].str() : (*it)[2].str();
    const sdf::ElementPtr element = root_.Element() ? find_named(root_.Element(), name) : nullptr;
    if (element) return where(element);
  }
  return {file_.string(), 0};
}

FileLocation SdfSource::where(const sdf::ElementPtr& element) const {
  for (sdf::ElementPtr e = element; e; e = e->GetParent()) {
    const int line = e->LineNumber() ? *e->LineNumber() : line_in_xml(e);
    if (line > 0) return {e->FilePath(), line};
  }
  return {file_.string(), 0};
}

/// libsdformat keeps no lines of custom elements; their path leads to them in the XML itself.
int SdfSource::line_in_xml(const sdf::ElementPtr& element) const {
  std::vector<sdf::ElementPtr> path;
  for (sdf::ElementPtr e = element; e && e->GetName() != "sdf"; e = e->GetParent()) {
    if (e->FilePath() != element->FilePath()) break;
    path.push_back(e);
  }
  const tinyxml2::XMLElement* xml = xml_of(element->FilePath())->RootElement();
  for (auto it = path.rbegin(); it != path.rend() && xml != nullptr; ++it) {
    const sdf::ElementPtr parent = (*it)->GetParent();
    const bool is_top = !parent || parent->FilePath() != (*it)->FilePath();
    xml = nth_child(xml, (*it)->GetName(), is_top ? 0 : ordinal(*it));
  }
  return xml != nullptr ? xml->GetLineNum() : 0;
}

tinyxml2::XMLDocument* SdfSource::xml_of(const std::string& file) const {
  auto& document = xml_[file];
  if (!document) {
    document = std::make_unique<tinyxml2::XMLDocument>();
    document->LoadFile(file.c_str());
  }
  return document.get();
}

std::set<fs::path> SdfSource::files() const {
  std::set<fs::path> files = sdf_files();
  files.insert(resources_.begin(), resources_.end());
  return files;
}

std::set<fs::path> SdfSource::sdf_files() const {
  std::set<fs::path> files{file_};
  const std::function<void(const sdf::ElementPtr&)> visit = [&](const sdf::ElementPtr& element) {
    const fs::path file = element->FilePath();
    if (is_file(file)) files.insert(fs::absolute(file).lexically_normal());
    for_each_child(element, visit);
  };
  visit(root_.Element());
  return files;
}

fs::path SdfSource::find_resource(const sdf::ElementPtr& element, const std::string& uri) const {
  std::vector<fs::path> candidates;
  if (uri.starts_with("model://")) {
    for (const fs::path& folder : model_folders_) candidates.push_back(folder / uri.substr(8));
  } else {
    const std::string path = uri.starts_with("file://") ? uri.substr(7) : uri;
    candidates.push_back(fs::path(element->FilePath()).parent_path() / path);
  }
  for (const fs::path& candidate : candidates) {
    if (is_file(candidate))
      return *resources_.insert(fs::absolute(candidate).lexically_normal()).first;
  }
  const std::string subject = describe(element);
  throw Error(ErrorCode::kBadFile, where(element),
              subject + " names the file '" + uri + "', which does not exist (searched " +
                  candidates.front().lexically_normal().string() +
                  (candidates.size() > 1 ? " and the model path)" : ")"))
      .about(subject);
}

}  // namespace tether::sim
