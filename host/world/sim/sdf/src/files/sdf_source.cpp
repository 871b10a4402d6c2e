// Reads one SDF file and those that it includes with libsdformat, each from its copy (SdfStage).
// Reading included files alone, before the file that includes them, gives typed errors for all;
// libsdformat repeats those of deeper ones on the console, which is discarded.

#include "files/sdf_source.h"

#include "files/lookups.h"
#include "files/mesh_companions.h"
#include "files/quiet_console.h"
#include "files/sdf_numbers.h"
#include "files/sdf_rules.h"
#include "files/sdf_tree.h"

#include <algorithm>
#include <new>
#include <regex>
#include <set>
#include <sstream>
#include <vector>

#include <tinyxml2.h>

#include <tether/os/text_file.h>

namespace tether::sim {

namespace fs = std::filesystem;

namespace {

/// Longer messages of libsdformat, which may quote a whole file, are cut: std::regex needs stack
/// for every character.
constexpr std::size_t kLongestMessage = 2000;
constexpr std::uintmax_t kLargestResource = std::uintmax_t{1} << 24;

const std::regex& unread() {
  static const std::regex message("Error reading element <(\\S+)>");
  return message;
}

/// One line, without trailing full stop.
std::string one_line(const std::string& text) {
  std::istringstream words(text.substr(0, kLongestMessage));
  std::string line;
  for (std::string word; words >> word;) line += (line.empty() ? "" : " ") + word;
  while (line.ends_with('.')) line.pop_back();
  return line;
}

/// libsdformat continues after these.
bool is_warning(const sdf::Error& error) {
  return error.Code() == sdf::ErrorCode::ATTRIBUTE_INCORRECT_TYPE ||
         error.Code() == sdf::ErrorCode::ELEMENT_DEPRECATED;
}

/// The element with that name attribute that is nearest to `element`, or it itself.
sdf::ElementPtr find_named(const sdf::ElementPtr& element, const std::string& name) {
  std::vector<sdf::ElementPtr> level{element};
  while (!level.empty()) {
    std::vector<sdf::ElementPtr> next;
    for (const sdf::ElementPtr& candidate : level) {
      if (name_attribute(candidate) == name) return candidate;
      for_each_child(candidate, [&](const sdf::ElementPtr& child) { next.push_back(child); });
    }
    level = std::move(next);
  }
  return nullptr;
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

/// The line of the first element with "::" in its name, which libsdformat's converters take apart;
/// 0: there is none.
int line_of_nested_name(const tinyxml2::XMLElement& element) {
  const char* name = element.Attribute("name");
  if (name != nullptr && std::string_view(name).find("::") != std::string_view::npos)
    return element.GetLineNum();
  for (const auto* child = element.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement())
    if (const int line = line_of_nested_name(*child)) return line;
  return 0;
}

}  // namespace

void refuse_by_library(const FileLocation& where) {
  std::string reason;
  try {
    throw;
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const sdf::Exception& error) {  // of its assertions; no std::exception
    reason = error.GetErrorStr();
  } catch (const std::exception& error) {
    reason = error.what();
  }
  throw Error(ErrorCode::kBadFile, where,
              "libsdformat cannot read it (" + one_line(reason) + ")" +
                  (where.line > 0 ? ". A name with '::' is that of something in a nested model; "
                                    "write it without"
                                  : ""));
}

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
  for (sdf::ElementPtr child = element->GetFirstElement(), next; child; child = next) {
    next = child->GetNextElement();
    visit(child);
  }
}

SdfSource::SdfSource(const fs::path& file, const WorldOptions& options, const WarningSink& warn)
    : file_(fs::absolute(file).lexically_normal()),
      options_(options),
      path_(file_, options.model_folders),
      stage_(file_, path_, options_, warn) {
  read(warn);
}

void SdfSource::read(const WarningSink& warn) {
  const QuietConsole quiet;
  sdf::ParserConfig config;
  config.SetFindCallback([](const std::string&) { return std::string(); });
  // As errors they have a place. The elements that SDF does not know are named by `check_elements`.
  config.SetWarningsPolicy(sdf::EnforcementPolicy::ERR);
  config.SetUnrecognizedElementsPolicy(sdf::EnforcementPolicy::LOG);
  // With a reader of other formats, libsdformat leaves an <include> of what is not named .sdf
  // alone.
  config.RegisterCustomModelParser(
      [](const sdf::NestedInclude&, sdf::Errors&) { return sdf::InterfaceModelPtr(); });
  SdfTrees trees;
  for (const SdfStage::File& staged : stage_.files()) {
    sdf::Errors errors;
    bool is_read = false;
    do {
      errors.clear();
      const auto* root = stage_.root_of(staged.original);
      parsed_ = trees.empty(root);
      is_read =
          ask_library({staged.original.string(), root != nullptr ? line_of_nested_name(*root) : 0},
                      [&] { return sdf::readFile(staged.copy, config, parsed_, errors); });
    } while (leave_out_unreadable(staged, errors, warn));
    for (const sdf::Error& error : errors) {
      if (warn && is_warning(error)) warn(warning_of(error));
    }
    std::erase_if(errors, is_warning);
    if (!errors.empty()) refuse_by(errors);
    if (!is_read) {
      require_a_handle_for(staged.copy);
      throw Error(ErrorCode::kBadFile, {staged.original.string(), 0}, "not an SDF file");
    }
    trees.place_included(parsed_->Root());
    if (staged.original != file_)
      trees.keep_model(SdfStage::as_model(staged.copy), *parsed_->Root());
  }
}

/// Without --strict, a world goes without what has a value that SDF does not allow.
/// @return whether something was left out
bool SdfSource::leave_out_unreadable(const SdfStage::File& staged, sdf::Errors errors,
                                     const WarningSink& warn) {
  std::erase_if(errors, is_warning);
  if (!options_.is_tolerant || errors.empty() || !errors.front().LineNumber()) return false;
  const std::string reason = reason_of(errors.front());
  std::smatch match;
  if (!std::regex_search(reason, match, unread())) return false;
  const int line = *errors.front().LineNumber();
  const std::string left_out = stage_.leave_out(staged, match[1].str(), line);
  if (!left_out.empty() && warn)
    warn({Consequence::kMissing,
          {staged.original.string(), line},
          left_out,
          "cannot be used and is left out: " + reason});
  return !left_out.empty();
}

/// Of an attribute that SDF does not know, or of a deprecated element.
Warning SdfSource::warning_of(const sdf::Error& error) const {
  const std::string path = error.XmlPath().value_or("");
  const std::size_t at = path.rfind("[@");
  const bool is_attribute = error.Code() == sdf::ErrorCode::ATTRIBUTE_INCORRECT_TYPE;
  const std::string name = path.substr(std::min(at, path.size()));
  return {Consequence::kNoEffect, where(error),
          is_attribute ? "attribute " +
                             name.substr(std::min<std::size_t>(2, name.size()), name.find('=') - 2)
                       : "<" + path.substr(path.rfind('/') + 1) + ">",
          is_attribute ? "is not known to SDF; ignored" : "is deprecated in SDF"};
}

void SdfSource::load() {
  const QuietConsole quiet;
  sdf::Errors errors = ask_library({file_.string()}, [&] { return root_.Load(parsed_); });
  std::erase_if(errors, is_warning);
  if (!errors.empty()) refuse_by(errors);
}

/// What is wrong, with the value in question, which libsdformat says on the console only.
std::string SdfSource::reason_of(const sdf::Error& error) const {
  const FileLocation at = where(error);
  std::string reason = one_line(error.Message());
  std::smatch match;
  if (!std::regex_match(reason, match, unread()) || !error.LineNumber()) return reason;
  const auto* root = stage_.root_of(at.file);
  const auto* xml = root != nullptr ? element_at(*root, match[1].str(), at.line) : nullptr;
  if (xml == nullptr || xml->GetText() == nullptr) return reason;
  const std::string text = one_line(xml->GetText());
  reason += ": '" + text + "' is not a value that SDF allows for it";
  static const std::regex yes_or_no("yes|no|on|off", std::regex::icase);
  if (std::regex_match(text, yes_or_no)) reason += ". Write true or false";
  return reason;
}

void SdfSource::refuse_by(const sdf::Errors& errors) const {
  require_a_handle_for(file_.string());
  throw Error(ErrorCode::kBadFile, where(errors.front()), reason_of(errors.front()));
}

FileLocation SdfSource::where(const sdf::Error& error) const {
  if (error.LineNumber()) {
    const std::string file = stage_.original_of(error.FilePath().value_or(""));
    return {file.empty() ? file_.string() : file, *error.LineNumber()};
  }
  // Errors between elements have names instead of lines, the inner one first: "joint with name[j]
  // in model with name[m]". The place is that of the innermost one that is found in the outer ones.
  static const std::regex naming("name\\[([^\\]]*)\\]");
  const std::string message = error.Message().substr(0, kLongestMessage);
  std::vector<std::string> names;
  for (std::sregex_iterator it(message.begin(), message.end(), naming), end; it != end; ++it)
    names.push_back((*it)[1].str());
  std::ranges::reverse(names);
  sdf::ElementPtr place;
  for (const std::string& name : names) {
    if (const auto inner = find_named(place ? place : element(), name)) place = inner;
  }
  return place ? where(place) : FileLocation{file_.string(), 0};
}

FileLocation SdfSource::where(const sdf::ElementPtr& element) const {
  for (sdf::ElementPtr e = element; e; e = e->GetParent()) {
    const int line = e->LineNumber() ? *e->LineNumber() : line_in_xml(e);
    if (line > 0) return {stage_.original_of(e->FilePath()), line};
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
  const tinyxml2::XMLElement* xml = stage_.root_of(stage_.original_of(element->FilePath()));
  for (auto it = path.rbegin(); it != path.rend() && xml != nullptr; ++it) {
    const sdf::ElementPtr parent = (*it)->GetParent();
    const bool is_top = !parent || parent->FilePath() != (*it)->FilePath();
    xml = nth_child(xml, (*it)->GetName(), is_top ? 0 : ordinal(*it));
  }
  return xml != nullptr ? xml->GetLineNum() : 0;
}

std::set<fs::path> SdfSource::files() const {
  std::set<fs::path> files = sdf_files();
  files.insert(resources_.begin(), resources_.end());
  return files;
}

std::set<fs::path> SdfSource::sdf_files() const {
  std::set<fs::path> files;
  for (const SdfStage::File& staged : stage_.files()) files.insert(staged.original);
  return files;
}

fs::path SdfSource::find_resource(const sdf::ElementPtr& element, const std::string& uri) const {
  const auto found = find(element, uri);
  if (found && is_file(*found)) return use(*found);
  if (options_.is_tolerant) return {};
  const std::string subject = describe(element);
  throw Error(ErrorCode::kBadFile, where(element),
              subject + " names the file '" + uri + "', which is not found. " +
                  path_.advice_on_missing(uri, stage_.original_of(element->FilePath())))
      .about(subject);
}

std::optional<fs::path> SdfSource::find(const sdf::ElementPtr& element,
                                        const std::string& uri) const {
  return path_.find(uri, stage_.original_of(element->FilePath()));
}

fs::path SdfSource::use(const fs::path& file) const {
  return *resources_.insert(fs::absolute(file).lexically_normal()).first;
}

std::string SdfSource::read_resource(const fs::path& file) const {
  return sim::read_file(use(file), kLargestResource);
}

const std::vector<fs::path>& SdfSource::companions_of(const fs::path& mesh) const {
  const auto [known, is_new] = companions_.try_emplace(mesh);
  if (is_new) known->second = mesh_companions(mesh);
  for (const fs::path& file : known->second) use(file);
  return known->second;
}

}  // namespace tether::sim
