#include <charconv>
#include <cmath>
#include <optional>
#include <vector>

#include <tether/base/text.h>
#include <tether/mission/mission.h>
#include <tether/toml/table.h>

namespace tether::mission {
namespace {

using Words = std::vector<std::string_view>;

constexpr const char* kGrammar =
    "a condition is 'QUANTITY [of NAME] <= NUMBER UNIT [in SHARE %]', or with >=";

Words words_of(std::string_view text) {
  constexpr std::string_view kSpace = " \t";
  Words words;
  for (auto at = text.find_first_not_of(kSpace); at != std::string_view::npos;
       at = text.find_first_not_of(kSpace, at)) {
    const auto end = std::min(text.find_first_of(kSpace, at), text.size());
    words.push_back(text.substr(at, end - at));
    at = end;
  }
  return words;
}

std::optional<double> number_of(std::string_view word) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  const bool is_whole = error == std::errc() && end == word.data() + word.size();
  return is_whole && std::isfinite(number) ? std::optional(number) : std::nullopt;
}

Failure wrong(const std::string& message) {
  return {Failure::Kind::kInvalid, message};
}
std::string quoted(std::string_view text) {
  return "\"" + std::string(text) + "\"";
}

/// Takes the words from front to back.
class Parser {
 public:
  explicit Parser(std::string_view text) : words_(words_of(text)) {}

  Result<Condition> parse() {
    Condition condition;
    for (const auto part : {&Parser::quantity, &Parser::subject, &Parser::relation, &Parser::number,
                            &Parser::unit, &Parser::share}) {
      if (const Status status = (this->*part)(condition); !status) return status.failure();
    }
    if (next_ < words_.size()) return wrong("has " + quoted(words_[next_]) + " at its end");
    return condition;
  }

 private:
  std::string_view take() { return next_ < words_.size() ? words_[next_++] : std::string_view(); }
  bool take_if(std::string_view word) {
    const bool is_next = next_ < words_.size() && words_[next_] == word;
    next_ += is_next ? 1 : 0;
    return is_next;
  }

  Status quantity(Condition& condition) {
    const std::string_view name = take();
    condition.quantity = find_quantity(name);
    if (condition.quantity != nullptr) return ok_status();
    Words names;
    for (const Quantity& quantity : quantities()) names.push_back(quantity.name);
    return wrong("has no quantity " + quoted(name) + "; " + allowed_hint(name, names));
  }

  Status subject(Condition& condition) {
    if (!take_if("of")) return ok_status();
    condition.of = take();
    if (condition.quantity->subject == Subject::kNone)
      return wrong("has 'of " + condition.of + "', but " + quoted(condition.quantity->name) +
                   " is of the UAV itself");
    if (condition.of.empty()) return wrong("has no name after 'of'");
    return ok_status();
  }

  Status relation(Condition& condition) {
    const std::string_view word = take();
    condition.at_most = word == "<=";
    if (condition.at_most || word == ">=") return ok_status();
    return wrong("has " + quoted(word) + " where '<=' or '>=' must be; " + kGrammar);
  }

  Status number(Condition& condition) {
    const std::string_view word = take();
    const std::optional<double> bound = number_of(word);
    if (!bound) return wrong("has " + quoted(word) + " where a number must be; " + kGrammar);
    condition.bound = *bound;
    return ok_status();
  }

  Status unit(Condition& condition) {
    const std::string_view name = take();
    Words names;
    for (const Unit& unit : units()) {
      if (unit.dimension != condition.quantity->dimension) continue;
      names.push_back(unit.name);
      if (unit.name == name) condition.unit = &unit;
    }
    if (condition.unit != nullptr) return ok_status();
    if (!name.empty() && name != "in")
      return wrong("has the unit " + quoted(name) + "; of " + quoted(condition.quantity->name) +
                   ", " + allowed_hint(name, names));
    std::string forms;
    for (const std::string_view unit : names)
      forms += (forms.empty() ? " " : " or ") + toml::number_text(condition.bound) + " " +
               std::string(unit);
    return wrong("lacks a unit. Write" + forms);
  }

  Status share(Condition& condition) {
    if (!take_if("in")) return ok_status();
    std::string_view word = take();
    const bool has_sign = word.ends_with('%');
    if (has_sign) word.remove_suffix(1);
    const std::optional<double> percent = number_of(word);
    if (!percent || *percent <= 0.0 || *percent > 100.0 || !(has_sign || take_if("%")))
      return wrong("must end with a share above 0 % and at most 100 %, such as 'in 95 %'");
    condition.share = *percent / 100.0;
    return ok_status();
  }

  Words words_;
  std::size_t next_ = 0;
};

}  // namespace

std::string Condition::text() const {
  std::string text(quantity->name);
  if (!of.empty()) text += " of " + of;
  text += at_most ? " <= " : " >= ";
  text += toml::number_text(bound) + " " + std::string(unit->name);
  if (share < 1.0) text += " in " + toml::number_text(100.0 * share) + " %";
  return text;
}

Result<Condition> parse_condition(std::string_view text) {
  return Parser(text).parse();
}

}  // namespace tether::mission
