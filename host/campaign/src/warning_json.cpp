#include "warning_json.h"

#include <algorithm>
#include <cstdint>
#include <limits>

#include <fmt/format.h>

namespace tether::campaign {

Json json_of(const Warning& warning) {
  return Json{{"consequence", name(warning.consequence)},
              {"file", warning.where.file},
              {"line", warning.where.line},
              {"subject", warning.subject},
              {"message", warning.message},
              {"can_change_verdict", warning.can_change_verdict}};
}

Warning read_warning(const JsonReader& json) {
  const std::string word = json.text("consequence");
  const auto consequence =
      std::ranges::find(kConsequences, word, [](Consequence c) { return name(c); });
  if (consequence == kConsequences.end()) json.fail("consequence", fmt::format("is \"{}\"", word));
  constexpr std::uint64_t kMostLines = std::numeric_limits<int>::max();
  return {*consequence,
          {json.text("file"), static_cast<int>(std::min(json.count("line"), kMostLines))},
          json.text("subject"),
          json.text("message"),
          // Results of earlier releases have none.
          json.has("can_change_verdict") ? json.boolean("can_change_verdict")
                                         : usually_changes_verdict(*consequence)};
}

}  // namespace tether::campaign
