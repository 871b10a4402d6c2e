#pragma once

#include <set>
#include <string>
#include <vector>

namespace tether::report {

/// The texts between each `open` and the next `close`.
inline std::vector<std::string> between(const std::string& text, const std::string& open,
                                        const std::string& close) {
  std::vector<std::string> found;
  for (auto at = text.find(open); at != std::string::npos; at = text.find(open, at + 1)) {
    const auto begin = at + open.size();
    const auto end = text.find(close, begin);
    if (end == std::string::npos) break;
    found.push_back(text.substr(begin, end - begin));
  }
  return found;
}

/// References to anything outside the page.
inline std::vector<std::string> external_references(const std::string& page) {
  std::vector<std::string> found;
  for (const char* attribute : {" src=\"", " href=\"", " href='", "url(", "@import"}) {
    for (const std::string& target : between(page, attribute, "\n")) {
      if (!target.starts_with("#") && !target.starts_with("data:"))
        found.push_back(target.substr(0, 60));
    }
  }
  return found;
}

/// Ids that occur more than once.
inline std::vector<std::string> repeated_ids(const std::string& page) {
  std::vector<std::string> repeated;
  std::set<std::string> seen;
  for (const char* quote : {"\"", "'"}) {
    for (const std::string& id : between(page, std::string(" id=") + quote, quote)) {
      if (!seen.insert(id).second) repeated.push_back(id);
    }
  }
  return repeated;
}

}  // namespace tether::report
