#include "shared/value.h"

#include <sstream>

namespace tether::app {

Value value_of(const CLI::Option& option) {
  // The name of the type, then after ":" what its checks say: `within`, or CLI::IsMember.
  const std::string type = option.get_type_name();
  const std::size_t colon = type.find(':');
  Value value{.word = type.substr(0, colon)};
  const std::string checks = colon == std::string::npos ? "" : type.substr(colon + 1);
  value.is_whole = value.word == "UINT" || value.word == "INT";
  if (value.is_whole || value.word == "FLOAT") value.word = "NUMBER";
  if (!checks.starts_with('{')) {
    value.range = checks;
    return value;
  }
  std::istringstream choices(checks.substr(1, checks.find('}') - 1));
  value.word.clear();
  for (std::string choice; std::getline(choices, choice, ',');) {
    value.word += (value.choices.empty() ? "" : "|") + choice;
    value.choices.push_back(choice);
  }
  return value;
}

}  // namespace tether::app
