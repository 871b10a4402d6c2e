#include <iomanip>
#include <iterator>
#include <locale>
#include <sstream>

#include <tether/computer/clock.h>

namespace tether::computer {
namespace {

/// What follows "NAME*" in a clock's text.
enum class Rate { kNone, kFactor, kComputing };

struct Traits {
  std::string_view name;
  Rate rate;
  bool repeats;
  bool allows_parallel;
  bool counts_waiting;
  bool needs_barrier;
};

// In the order of ClockKind.
constexpr Traits kTraits[] = {
    // name         rate                 repeats  parallel  waiting  barrier
    {"wall", Rate::kFactor, false, true, true, false},
    {"cpu", Rate::kFactor, false, false, false, false},
    {"scripted", Rate::kComputing, true, true, false, true},
    {"unstamped", Rate::kNone, false, false, true, true},
    {"counted", Rate::kNone, true, false, false, true},
    {"replayed", Rate::kNone, true, false, false, true},
};
static_assert(std::size(kTraits) == kClockKinds);

const Traits& traits(ClockKind kind) {
  static constexpr Traits kUnknown{"unknown", Rate::kNone, false, false, false, false};
  const auto index = static_cast<std::size_t>(kind);
  return index < kClockKinds ? kTraits[index] : kUnknown;
}

/// A decimal number that is all of the text, whatever the locale.
std::optional<double> parse_rate(const std::string& text) {
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  double value = 0.0;
  if (!(stream >> value) || stream.peek() != std::istringstream::traits_type::eof()) return {};
  if (!(value >= kLeastRate && value <= kLargestRate)) return {};
  return value;
}

/// The shortest text that parses to the same value.
std::string rate_text(double value) {
  constexpr int kEnough = 17;
  std::string text;
  for (int digits = 1; digits <= kEnough; ++digits) {
    std::ostringstream out;
    out.imbue(std::locale::classic());
    out << std::setprecision(digits) << value;
    text = out.str();
    if (parse_rate(text) == value) break;
  }
  return text;
}

}  // namespace

std::string_view name(ClockKind kind) {
  return traits(kind).name;
}

std::optional<ClockKind> clock_kind(std::string_view name) {
  for (std::size_t kind = 0; kind < kClockKinds; ++kind)
    if (kTraits[kind].name == name) return static_cast<ClockKind>(kind);
  return std::nullopt;
}

std::string Clock::text() const {
  const std::string clock(name(kind));
  switch (traits(kind).rate) {
    case Rate::kFactor:
      return is_scaled() ? clock + "*" + rate_text(factor) : clock;
    case Rate::kComputing:
      return clock + "*" + rate_text(static_cast<double>(computing.count()) / 1e6);
    case Rate::kNone:
      break;
  }
  return clock;
}

bool Clock::repeats() const {
  return traits(kind).repeats;
}
bool Clock::allows_parallel() const {
  return traits(kind).allows_parallel;
}
bool Clock::counts_waiting() const {
  return traits(kind).counts_waiting;
}
bool Clock::needs_barrier() const {
  return traits(kind).needs_barrier || (kind == ClockKind::kWall && is_scaled());
}

namespace {

/// None: not a clock.
std::optional<Clock> clock_of(const std::string& text) {
  const std::size_t star = text.find('*');
  const auto kind = clock_kind(text.substr(0, star));
  if (!kind) return std::nullopt;
  Clock clock{.kind = *kind};
  const Rate rate = traits(*kind).rate;
  if (star == std::string::npos)
    return rate == Rate::kComputing ? std::nullopt : std::optional(clock);
  const auto value = parse_rate(text.substr(star + 1));
  if (rate == Rate::kNone || !value) return std::nullopt;
  if (rate == Rate::kFactor) clock.factor = *value;
  if (rate == Rate::kComputing) clock.computing = duration_from_seconds(*value * 1e-3);
  return clock;
}

}  // namespace

Result<Clock> parse_clock(const std::string& text) {
  if (const auto clock = clock_of(text)) return *clock;
  return Failure{
      Failure::Kind::kInvalid,
      "'" + text +
          "' is not a clock. Allowed: wall, cpu, wall*FACTOR or cpu*FACTOR (cpu*4: a target "
          "that is four times slower; 1e-6 to 1e6), counted, replayed, scripted*MILLISECONDS"};
}

}  // namespace tether::computer
