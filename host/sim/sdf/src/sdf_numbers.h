#pragma once

#include <optional>
#include <string>
#include <vector>

namespace tinyxml2 {
class XMLDocument;
}

namespace tether::sim {

/// The numbers of a text, separated by blanks; none where anything in it is no number. "inf" and
/// "nan" are numbers; a magnitude beyond a double's is none.
std::optional<std::vector<double>> parse_numbers(const std::string& text);

/// Refuses what libsdformat would read in part: it takes the numbers at the beginning of a text and
/// forgets the rest, "1 kg" and "2,5" alike. Every element and attribute that SDF declares numeric
/// must be as many numbers as it declares, and nothing else. Left alone is what SDF does not know:
/// the content of plugins and custom elements.
/// @param file the name of the file that `xml` was read from, for the message
/// @throws Error(kBadFile) with file and line at the first text that is more, or less.
void check_numbers(const std::string& file, const tinyxml2::XMLDocument& xml);

}  // namespace tether::sim
