#include "files/sdf_xml.h"

#include "files/lookups.h"
#include "files/urdf.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include <tether/base/error.h>

namespace tether::sim {
namespace {

namespace fs = std::filesystem;

using tinyxml2::XMLDocument;
using tinyxml2::XMLElement;

constexpr std::uintmax_t kLargestFile = std::uintmax_t{1} << 30;

[[noreturn]] void refuse_file(const fs::path& file, int line, const std::string& problem) {
  throw Error(ErrorCode::kBadFile, {file.string(), line}, problem);
}

struct Problem {
  tinyxml2::XMLError error;
  const char* words;
};
constexpr std::array<Problem, 10> kProblems = {{
    {tinyxml2::XML_ERROR_PARSING_ELEMENT,
     "the tag is not complete; it must be <name …> or </name>"},
    {tinyxml2::XML_ERROR_PARSING_ATTRIBUTE,
     "an attribute is not complete; it must be name=\"value\", and each name may occur once"},
    {tinyxml2::XML_ERROR_PARSING_TEXT, "the text is not followed by a tag; close the element"},
    {tinyxml2::XML_ERROR_PARSING_CDATA, "<![CDATA[ is not closed; add ]]>"},
    {tinyxml2::XML_ERROR_PARSING_COMMENT, "the comment is not closed; add -->"},
    {tinyxml2::XML_ERROR_PARSING_DECLARATION,
     "<?xml … ?> is not closed, or is not at the beginning of the file"},
    {tinyxml2::XML_ERROR_PARSING_UNKNOWN, "<! is not closed; add >"},
    {tinyxml2::XML_ERROR_MISMATCHED_ELEMENT, "is not closed by a tag of the same name"},
    {tinyxml2::XML_ERROR_PARSING,
     "the file ends before every element is closed, or goes on after "
     "the last one"},
    {tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED, "elements are nested too deeply"},
}};

/// "link" of "Error=… Line number=3: XMLElement name=link"; empty for other errors.
std::string element_of(const XMLDocument& document) {
  const std::string text = document.ErrorStr();
  constexpr std::string_view kName = "XMLElement name=";
  const std::size_t at = text.rfind(kName);
  return at == std::string::npos ? "" : text.substr(at + kName.size());
}

std::string words_of(const XMLDocument& document) {
  const auto* const found = std::ranges::find(kProblems, document.ErrorID(), &Problem::error);
  if (found == kProblems.end()) return document.ErrorName();
  const std::string element = element_of(document);
  const bool is_named = found->error == tinyxml2::XML_ERROR_MISMATCHED_ELEMENT && !element.empty();
  return (is_named ? "<" + element + "> " : "") + found->words;
}

/// How many bytes the character at the front has; 0 if it is not UTF-8.
std::size_t character(std::string_view text) {
  const auto byte = [&](std::size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u;
  };
  const unsigned lead = byte(0);
  if (lead < 0x80) return 1;
  const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC2 || lead > 0xF4) return 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((byte(i) & 0xC0u) != 0x80) return 0;
  return length;
}

/// Comments may be in any encoding: nobody reads them.
void require_utf8(const fs::path& file, std::string_view text) {
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF") ||
      text.substr(0, 4).find('\0') != std::string_view::npos)
    refuse_file(file, 1, "is text in UTF-16 or UTF-32, or no text at all. Save it as UTF-8");
  int line = 1;
  for (std::size_t at = 0; at < text.size();) {
    if (text.substr(at).starts_with("<!--")) {
      const std::size_t end = std::min(text.find("-->", at), text.size());
      line += static_cast<int>(std::ranges::count(text.substr(at, end - at), '\n'));
      at = end;
      continue;
    }
    const std::size_t length = character(text.substr(at));
    if (length == 0)
      refuse_file(file, line,
                  "has a character that is not UTF-8 (a file in Latin-1?). Save it as UTF-8");
    line += text[at] == '\n' ? 1 : 0;
    at += length;
  }
}

void require_sdf(const fs::path& file, const XMLDocument& document) {
  const XMLElement* root = document.RootElement();
  if (root == nullptr)
    refuse_file(file, 0, "has no element; the outermost element of an SDF file must be <sdf>");
  if (std::string_view(root->Name()) != "sdf")
    refuse_file(file, root->GetLineNum(),
                "the outermost element is <" + std::string(root->Name()) + ">; it must be <sdf>");
}

}  // namespace

std::unique_ptr<XMLDocument> read_xml(const fs::path& file) {
  if (is_folder(file))
    refuse_file(file, 0, "is a directory; give the SDF file in it, such as model.sdf");
  if (!is_file(file)) refuse_file(file, 0, "there is no such file");
  const std::string text = read_file(file, kLargestFile);
  require_utf8(file, text);
  auto document = std::make_unique<XMLDocument>();
  document->Parse(text.data(), text.size());
  if (document->Error() && document->ErrorID() != tinyxml2::XML_ERROR_EMPTY_DOCUMENT)
    refuse_file(file, document->ErrorLineNum(), "not well-formed XML: " + words_of(*document));
  if (const XMLElement* robot = document->FirstChildElement("robot")) {
    const std::string sdf = sdf_of_urdf(file, *robot, text);
    document->Parse(sdf.data(), sdf.size());
  }
  require_sdf(file, *document);
  return document;
}

}  // namespace tether::sim
