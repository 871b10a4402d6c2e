#pragma once

#include <optional>
#include <string>
#include <vector>

#include <sdf/Element.hh>

namespace tinyxml2 {
class XMLDocument;
}

namespace tether::sim {

/// What SDF declares a document to be, in its latest version. Reading it takes a tenth of a second,
/// so this is done once. Copy it to change it.
const sdf::ElementPtr& sdf_description();

/// The numbers of a text, separated by blanks; none if anything in it is not a number. "inf" and
/// "nan" are numbers; a magnitude beyond a double's is not.
std::optional<std::vector<double>> parse_numbers(const std::string& text);

/// Refuses text that libsdformat would read in part: it reads the numbers at the beginning and
/// ignores the rest ("1 kg", "2,5"). Every element and attribute that SDF declares numeric must
/// consist of exactly the declared count of numbers. Plugins and custom elements are not checked.
/// @param file the name of the file that `xml` was read from, for the message
/// @throws Error(kBadFile) with file, line and element for the first text that differs.
void check_numbers(const std::string& file, const tinyxml2::XMLDocument& xml);

}  // namespace tether::sim
