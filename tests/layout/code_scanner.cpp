#include "code_scanner.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>

namespace tether::layout {
namespace {

bool is_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}
bool is_blank(char c) {
  return std::isspace(static_cast<unsigned char>(c)) != 0;
}

std::string_view trim(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

bool contains_word(std::string_view text, std::string_view word) {
  return !lines_with_word(text, word).empty();
}

// ---- comments and literals
// --------------------------------------------------------------------------------------

/// Copies a source while blanking what is no code.
class Stripper {
 public:
  explicit Stripper(std::string_view source) : source_(source), out_(source) {}

  std::string run() {
    while (at_ < source_.size()) step();
    return std::move(out_);
  }

 private:
  bool starts_with(std::string_view text) const { return source_.substr(at_).starts_with(text); }

  void step() {
    if (starts_with("//")) {
      blank_until(source_.find('\n', at_));
    } else if (starts_with("/*")) {
      blank_until(after(source_.find("*/", at_ + 2), 2));
    } else if (starts_with("R\"") && !inside_word()) {
      raw_string();
    } else if (source_[at_] == '"') {
      literal('"');
    } else if (source_[at_] == '\'' && !is_digit_separator()) {
      literal('\'');
    } else {
      ++at_;
    }
  }

  /// A quote inside a number, as in 1'000. Encoding prefixes of literals (u8'a', L'a') begin with a
  /// letter.
  bool is_digit_separator() const {
    std::size_t begin = at_;
    while (begin > 0 && (is_word(source_[begin - 1]) || source_[begin - 1] == '\'')) --begin;
    return begin < at_ && std::isdigit(static_cast<unsigned char>(source_[begin])) != 0;
  }
  bool inside_word() const {
    return at_ > 0 && is_word(source_[at_ - 1]) &&
           source_.substr(0, at_).find_last_of("uUL8") != at_ - 1;
  }

  void literal(char quote) {
    std::size_t end = at_ + 1;
    while (end < source_.size() && source_[end] != quote && source_[end] != '\n') {
      end += source_[end] == '\\' ? 2U : 1U;
    }
    ++at_;
    blank_until(std::min(end, source_.size()));
    if (at_ < source_.size()) ++at_;
  }

  void raw_string() {
    const std::size_t open = source_.find('(', at_);
    if (open == std::string_view::npos) return blank_until(open);
    const std::string close = ")" + std::string(source_.substr(at_ + 2, open - at_ - 2)) + "\"";
    blank_until(after(source_.find(close, open), close.size()));
  }

  static std::size_t after(std::size_t found, std::size_t length) {
    return found == std::string_view::npos ? found : found + length;
  }

  void blank_until(std::size_t end) {
    for (end = std::min(end, source_.size()); at_ < end; ++at_) {
      if (source_[at_] != '\n') out_[at_] = ' ';
    }
  }

  std::string_view source_;
  std::string out_;
  std::size_t at_ = 0;
};

// ---- functions
// --------------------------------------------------------------------------------------------------

enum class Scope { kNamespace, kType, kFunction, kInitialiser };

/// The text without what stands inside parentheses, square and (after `template`) angle brackets,
/// so that keywords and signs that are left belong to the declaration itself.
std::string flatten(std::string_view head) {
  std::string flat;
  int depth = 0;
  for (const char c : head) {
    if (c == '(' || c == '[') flat += depth++ == 0 ? c : ' ';
    if (depth == 0) flat += c;
    if ((c == ')' || c == ']') && --depth == 0) flat += c;
  }
  return flat;
}

std::string_view without_template_heads(std::string_view head) {
  for (head = trim(head); head.starts_with("template"); head = trim(head)) {
    std::size_t at = head.find('<');
    if (at == std::string_view::npos) return head;
    int depth = 0;
    do {
      depth += head[at] == '<' ? 1 : head[at] == '>' ? -1 : 0;
      ++at;
    } while (at < head.size() && depth > 0);
    head.remove_prefix(at);
  }
  return head;
}

/// Whether what follows the parameter list up to an opening brace leaves that brace to be the
/// body's.
bool is_function_tail(std::string_view tail) {
  tail = trim(tail);
  if (tail.empty() || tail.starts_with("->")) return true;
  if (tail.starts_with(":") && !tail.starts_with("::"))
    return tail.back() == ')' || tail.back() == '}';
  constexpr std::array<std::string_view, 9> kQualifiers = {
      "const", "noexcept", "override", "final", "mutable", "volatile", "requires", "try", "&"};
  return std::any_of(kQualifiers.begin(), kQualifiers.end(),
                     [&](std::string_view qualifier) { return tail.starts_with(qualifier); });
}

/// What an opening brace opens, from the text since the last `;`, `{` or `}` of its scope.
Scope classify(std::string_view raw_head) {
  const std::string flat = flatten(without_template_heads(raw_head));
  const std::string_view head = trim(flat);
  if (contains_word(head, "namespace") || head.starts_with("extern")) return Scope::kNamespace;
  const std::size_t open = head.find('(');
  for (const std::string_view keyword : {"class", "struct", "union", "enum"}) {
    if (contains_word(head.substr(0, open), keyword)) return Scope::kType;
  }
  if (open == std::string_view::npos) return Scope::kInitialiser;
  const bool assigned = head.substr(0, open).find('=') != std::string_view::npos;
  if (assigned && !contains_word(head, "operator")) return Scope::kInitialiser;
  const std::size_t close = head.find(')', open);
  // operator() has an empty pair of parentheses before its parameter list.
  const std::size_t second =
      contains_word(head, "operator") ? head.find(')', close + 1) : std::string_view::npos;
  const std::size_t end = second != std::string_view::npos ? second : close;
  return is_function_tail(head.substr(end + 1)) ? Scope::kFunction : Scope::kInitialiser;
}

std::string name_of(std::string_view raw_head) {
  const std::string flat = flatten(without_template_heads(raw_head));
  const std::string_view before = trim(std::string_view(flat).substr(0, flat.find('(')));
  std::size_t begin = before.size();
  while (begin > 0 &&
         (is_word(before[begin - 1]) || before[begin - 1] == ':' || before[begin - 1] == '~'))
    --begin;
  return std::string(before.substr(begin));
}

/// Blanks preprocessor lines with their continuations.
std::string without_preprocessor(std::string text) {
  bool continued = false;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = std::string_view(text).substr(begin, end - begin);
    const bool directive = continued || trim(line).starts_with('#');
    continued = directive && line.ends_with('\\');
    if (directive)
      std::fill(text.begin() + static_cast<std::ptrdiff_t>(begin),
                text.begin() + static_cast<std::ptrdiff_t>(end), ' ');
    begin = end + 1;
  }
  return text;
}

/// Walks the braces of stripped code.
class BraceWalker {
 public:
  explicit BraceWalker(std::string_view code) : code_(code) {}

  std::vector<Function> run() {
    for (at_ = 0; at_ < code_.size(); ++at_) step(code_[at_]);
    return std::move(found_);
  }

 private:
  struct Open {
    Scope scope;
    int line;
    std::string name;
    std::size_t head;  ///< where the declaration around it began
  };

  bool declarations_here() const {
    return open_.empty() || open_.back().scope == Scope::kNamespace ||
           open_.back().scope == Scope::kType;
  }

  void step(char c) {
    if (c == '\n') ++line_;
    if (c == '{') return opened();
    if (c == '}') return closed();
    if (!declarations_here()) return;
    parentheses_ += c == '(' ? 1 : c == ')' ? -1 : 0;
    if (c == ';') head_ = at_ + 1;
    if (c == ':' && is_access_specifier()) head_ = at_ + 1;
  }

  bool is_access_specifier() const {
    const std::string_view head = trim(code_.substr(head_, at_ - head_));
    return head == "public" || head == "private" || head == "protected";
  }

  void opened() {
    if (!declarations_here() || parentheses_ > 0) {
      open_.push_back({Scope::kInitialiser, line_, {}, head_});
      return;
    }
    const std::string_view head = code_.substr(head_, at_ - head_);
    const Scope scope = classify(head);
    open_.push_back(
        {scope, line_, scope == Scope::kFunction ? name_of(head) : std::string(), head_});
    if (scope != Scope::kInitialiser) head_ = at_ + 1;
  }

  /// An initialiser is part of the declaration around it, which goes on; everything else ends one.
  void closed() {
    if (open_.empty()) return;
    const Open open = open_.back();
    open_.pop_back();
    if (open.scope == Scope::kFunction)
      found_.push_back({open.line, line_ - open.line + 1, open.name});
    if (open.scope == Scope::kInitialiser) {
      head_ = open.head;
    } else {
      head_ = at_ + 1;
    }
  }

  std::string_view code_;
  std::vector<Open> open_;
  std::vector<Function> found_;
  std::size_t at_ = 0;
  std::size_t head_ = 0;
  int line_ = 1;
  int parentheses_ = 0;
};

}  // namespace

std::string strip(std::string_view source) {
  return Stripper(source).run();
}

std::vector<Include> includes(std::string_view source) {
  // Blanking literals would blank quoted paths too, so directives are found in the stripped text
  // and read in the source.
  const std::string stripped = strip(source);
  std::vector<Include> found;
  int line = 0;
  for (std::size_t begin = 0; begin < source.size();) {
    ++line;
    const std::size_t end = std::min(source.find('\n', begin), source.size());
    const std::string_view code = trim(std::string_view(stripped).substr(begin, end - begin));
    const std::string_view text = source.substr(begin, end - begin);
    begin = end + 1;
    if (!code.starts_with('#') || !trim(code.substr(1)).starts_with("include")) continue;
    const std::size_t open = text.find_first_of("<\"");
    if (open == std::string_view::npos) continue;
    const bool quoted = text[open] == '"';
    const std::size_t close = text.find(quoted ? '"' : '>', open + 1);
    found.push_back({line, std::string(text.substr(open + 1, close - open - 1)), quoted});
  }
  return found;
}

std::vector<Function> functions(std::string_view source) {
  const std::string code = without_preprocessor(strip(source));
  return BraceWalker(code).run();
}

std::vector<int> lines_with_word(std::string_view stripped, std::string_view word) {
  std::vector<int> lines;
  int line = 1;
  std::size_t counted = 0;
  for (std::size_t at = stripped.find(word); at != std::string_view::npos;
       at = stripped.find(word, at + 1)) {
    line += static_cast<int>(std::count(stripped.begin() + static_cast<std::ptrdiff_t>(counted),
                                        stripped.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
    counted = at;
    const bool open_before = at == 0 || !is_word(stripped[at - 1]);
    const std::size_t end = at + word.size();
    if (open_before && (end == stripped.size() || !is_word(stripped[end]))) lines.push_back(line);
  }
  return lines;
}

int count_lines(std::string_view source) {
  const auto breaks = static_cast<int>(std::count(source.begin(), source.end(), '\n'));
  return breaks + (source.empty() || source.back() == '\n' ? 0 : 1);
}

}  // namespace tether::layout
