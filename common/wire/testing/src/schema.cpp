#include <fstream>
#include <iterator>
#include <map>
#include <regex>

#include <tether/wire_testing/schema.h>

namespace tether::wire {
namespace {

using Match = std::smatch;

/// What each name in the schema is: "table", "struct", "union", or an enumeration's number.
std::map<std::string, std::string> kinds_in(const std::string& schema) {
  std::map<std::string, std::string> kinds = {
      {"ubyte", "uint8"}, {"ushort", "uint16"}, {"bool", "uint8"}};
  const std::regex declared(R"((table|struct|union|enum)\s+(\w+)\s*(?::\s*(\w+))?)");
  for (std::sregex_iterator at(schema.begin(), schema.end(), declared), end; at != end; ++at) {
    const Match& found = *at;
    kinds[found[2]] = found[1] == "enum" ? kinds.at(found[3]) : found[1].str();
  }
  return kinds;
}

}  // namespace

std::vector<std::string> fields_in_schema(const std::string& file, const std::string& name) {
  std::ifstream in(file);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const std::string schema = std::regex_replace(text, std::regex("//[^\n]*"), "");
  const auto kinds = kinds_in(schema);
  Match body;
  if (!std::regex_search(schema, body,
                         std::regex("(table|struct)\\s+" + name + "\\s*\\{([^}]*)\\}")))
    return {};
  const std::string inside = body[2];
  std::vector<std::string> fields;
  const std::regex field(R"((\w+)\s*:\s*(\[?)(\w+)(\]?)([^;]*);)");
  for (std::sregex_iterator at(inside.begin(), inside.end(), field), end; at != end; ++at) {
    const Match& found = *at;
    const auto kind = kinds.find(found[3]);
    const std::string type = kind == kinds.end() ? found[3].str() : kind->second;
    std::string rest = std::regex_replace(found[5].str(), std::regex(R"(\s+$|\.0\b)"), "");
    fields.push_back(found[1].str() + ": " + found[2].str() + type + found[4].str() + rest);
  }
  return fields;
}

}  // namespace tether::wire
