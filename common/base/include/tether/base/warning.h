#pragma once

#include <array>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include <tether/base/error.h>

namespace tether {

/// What a warning about a world, a UAV or a profile means for the simulation: mostly, that a part
/// of it is not represented.
enum class Consequence {
  kDoubtful,          ///< it may be a mistake: a start, a sensor's setting, how a flight ended
  kMissing,           ///< it is missing from the world
  kLooksDifferent,    ///< cameras see it differently
  kBehavesDifferent,  ///< it moves, collides or measures differently
  kNoEffect,          ///< it has no effect here
};
inline constexpr std::array kConsequences = {
    Consequence::kDoubtful, Consequence::kMissing, Consequence::kLooksDifferent,
    Consequence::kBehavesDifferent, Consequence::kNoEffect};
/// "doubtful", "missing", "looks_different", "behaves_differently", "no_effect".
std::string_view name(Consequence consequence);
/// Whether something with this consequence can usually change what a flight is found to do. Looks
/// usually cannot: lights and shadows that differ a little.
constexpr bool usually_changes_verdict(Consequence consequence) {
  return consequence != Consequence::kLooksDifferent && consequence != Consequence::kNoEffect;
}

/// Something that a file asks for and a simulation does not do, or does with a doubtful result.
struct Warning {
  Consequence consequence = Consequence::kNoEffect;
  FileLocation where;   ///< its file is empty if there is none
  std::string subject;  ///< "visual 'v'", "<script> of visual 'v'"
  std::string message;  ///< what is wrong with the subject, and what to do; follows it
  /// Whether a flight with it could be found to do something else than one without: the answer
  /// about a flight has to name it.
  bool can_change_verdict = usually_changes_verdict(consequence);

  friend bool operator==(const Warning&, const Warning&) = default;
};

using WarningSink = std::function<void(const Warning&)>;

/// A sink that passes each warning to `warn`, with unprintable characters replaced; empty if `warn`
/// is.
WarningSink printable_warnings(WarningSink warn);

/// "file:line: subject message": one line.
std::string to_line(const Warning& warning);

/// The warnings under one heading for each consequence, which has their number: several lines, each
/// with an end of line. Where a consequence has more than `most` warnings, kinds of subjects with
/// their numbers replace them ("12 plugin, 3 <script>").
std::string grouped(std::span<const Warning> warnings, std::size_t most);

}  // namespace tether
