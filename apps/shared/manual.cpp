#include "shared/manual.h"

#include "shared/value.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <sstream>
#include <vector>

#include <tether/base/error.h>
#include <tether/os/text_file.h>

namespace tether::app {

namespace {

/// With more options than this, the synopsis only says that there are some.
constexpr std::size_t kFewOptions = 2;

/// Characters that roff would take for commands, or replace by typographic ones.
std::string literal(std::string_view text) {
  static const std::map<char, const char*> kNames = {
      {'\\', "\\e"},  {'-', "\\-"},   {'\'', "\\(aq"}, {'`', "\\(ga"},
      {'^', "\\(ha"}, {'~', "\\(ti"}, {'"', "\\(dq"}};
  std::string out = text.starts_with('.') ? "\\&" : "";
  for (const char c : text) {
    const auto name = kNames.find(c);
    out += name == kNames.end() ? std::string(1, c) : name->second;
  }
  return out;
}

/// Each sentence on a line of its own, the last one with a full stop.
std::string sentences(std::string text) {
  if (text.empty()) return text;
  if (!text.ends_with('.') && !text.ends_with(':')) text += '.';
  std::string out;
  std::size_t begin = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool is_end =
        text[i] == '.' && (i == 0 || text[i - 1] != '.') &&
        (i + 1 == text.size() || (i + 2 < text.size() && text[i + 1] == ' ' &&
                                  std::isupper(static_cast<unsigned char>(text[i + 2])) != 0));
    if (!is_end && i + 1 < text.size()) continue;
    out += literal(std::string_view(text).substr(begin, i + 1 - begin)) + "\n";
    begin = i + 2;
  }
  return out;
}

/// With the default of "[default]" as a sentence.
std::string description_of(const CLI::Option& option) {
  const auto [text, preset] = split_default(text_of(option));
  return sentences(text) + (preset.empty() ? "" : sentences("The default is " + preset));
}

/// "Fl -out Ar FOLDER", "Fl h , Fl -help", "Ar scenario".
std::string macros_of(const CLI::Option& option, bool is_argument) {
  const std::string more = is_list(option) ? " ..." : "";
  if (is_argument) return "Ar " + option.get_name(true) + more;
  std::string macros;
  for (const std::string& name : option.get_snames())
    macros += (macros.empty() ? "Fl " : " , Fl ") + name;
  for (const std::string& name : option.get_lnames())
    macros += (macros.empty() ? "Fl -" : " , Fl -") + name;
  if (!takes_value(option)) return macros;
  const Value value = value_of(option);
  return macros + (value.choices.empty() ? " Ar " : " Cm ") + value.word + more;
}

/// Without those that every command has: -h and --help.
std::vector<const CLI::Option*> own_options(const CLI::App& command) {
  return command.get_options([&](const CLI::Option* o) { return o != command.get_help_ptr(); });
}

struct Words {
  const CLI::App* command;
  std::string words;  ///< without the program's name
};

/// Those that can be called.
std::vector<Words> commands_of(const CLI::App& program, const std::string& before = "") {
  std::vector<Words> all;
  for (const CLI::App* command : subcommands_of(program)) {
    const std::string words = before + command->get_name();
    std::vector<Words> below = commands_of(*command, words + " ");
    if (below.empty()) below = {{command, words}};
    all.insert(all.end(), below.begin(), below.end());
  }
  return all;
}

std::string synopsis(const CLI::App& program) {
  std::string text = ".Sh SYNOPSIS\n";
  for (const auto& [command, words] : commands_of(program)) {
    text += ".Nm\n.Cm " + words + "\n";
    std::string required, optional, arguments;
    std::size_t count = 0;
    for (const CLI::Option* option : own_options(*command)) {
      const bool is_argument = option->get_positional();
      const std::string macros = macros_of(*option, is_argument);
      if (is_argument)
        arguments += (option->get_required() ? "." : ".Op ") + macros + "\n";
      else if (option->get_required())
        required += "." + macros + "\n";
      else if (++count <= kFewOptions)
        optional += ".Op " + macros + "\n";
    }
    text += required + (count <= kFewOptions ? optional : ".Op Ar options\n") + arguments;
  }
  return text + ".Nm\n.Op Ar command\n.Fl -help\n.Nm\n.Fl -version\n";
}

/// Paragraphs of the end of a help, with the words before ":" in the first line as title.
struct Paragraph {
  std::string title, text;
};
std::vector<Paragraph> paragraphs_of(const std::string& footer) {
  std::vector<Paragraph> paragraphs;
  for (std::size_t begin = 0; begin < footer.size();) {
    const std::size_t end = std::min(footer.find("\n\n", begin), footer.size());
    const std::string text = footer.substr(begin, end - begin);
    begin = end + 2;
    const std::size_t colon = text.find(':');
    const std::string title = text.substr(0, colon);
    const bool has_title = colon < text.find_first_of(".\n") && !title.starts_with(' ');
    paragraphs.push_back(has_title ? Paragraph{title, text.substr(colon + 1)}
                                   : Paragraph{"", text});
  }
  return paragraphs;
}

std::string capitalised(std::string text) {
  if (!text.empty())
    text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  return text;
}

/// "0 reached, 1 missed, 2 wrong use." as a list; another text as it is.
std::string codes_or_text(const std::string& text) {
  if (!text.starts_with("0 ")) return sentences(capitalised(text));
  std::string out = ".Bl -tag -width Ds\n";
  for (std::size_t begin = 0; begin < text.size();) {
    std::size_t end = text.find(", ", begin);
    while (end < text.size() && !(std::isdigit(static_cast<unsigned char>(text[end + 2])) != 0 &&
                                  text.substr(end + 3, 1) == " "))
      end = text.find(", ", end + 1);
    end = std::min(end, text.size());
    out += ".It " + text.substr(begin, 1) + "\n" +
           sentences(capitalised(text.substr(begin + 2, end - begin - 2)));
    begin = end + 2;
  }
  return out + ".El\n";
}

/// Indented lines are examples, or if they have a gap the rows of a list; others are one text.
std::string body_of(const Paragraph& paragraph) {
  std::string text, examples, rows;
  std::istringstream lines(paragraph.text);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t word = line.find_first_not_of(' ');
    if (word == std::string::npos) continue;
    const std::size_t gap = line.find(' ', word);
    if (!line.starts_with("  "))
      text += (text.empty() ? "" : " ") + line.substr(word);
    else if (gap == std::string::npos || line.substr(gap, 2) != "  ")
      examples += ".Dl " + literal(line.substr(word)) + "\n";
    else
      rows += ".It Ev " + line.substr(word, gap - word) + "\n" +
              sentences(line.substr(line.find_first_not_of(' ', gap)));
  }
  if (!rows.empty()) rows = ".Bl -tag -width Ds\n" + rows + ".El\n";
  return codes_or_text(text) + rows + examples;
}

/// The words that stand for a paragraph in a page: "Environment" of "Environment (of all)".
std::string name_of(const Paragraph& paragraph) {
  return paragraph.title.substr(0, paragraph.title.find(" ("));
}

std::string options_section(const CLI::App& program) {
  std::string text = ".Bl -tag -width Ds\n";
  for (const CLI::Option* option : program.get_options())
    text += ".It " + macros_of(*option, option->get_positional()) + "\n" + description_of(*option);
  text += ".El\n";
  std::map<std::string, std::string> first;  // commands, by option
  for (const auto& [command, words] : commands_of(program)) {
    text += ".Ss " + words + "\n" + sentences(command->get_description());
    std::string list;
    std::map<std::string, std::string> described;  // options, by command
    for (const CLI::Option* option : own_options(*command)) {
      const std::string description = description_of(*option);
      if (option->get_positional()) list += ".It " + macros_of(*option, true) + "\n" + description;
      if (option->get_lnames().empty()) continue;
      const std::string row = ".It " + macros_of(*option, false) + "\n" + description;
      const auto [at, is_new] = first.emplace(row, words);
      std::string& others = described[at->second];
      if (is_new)
        list += row;
      else
        others += (others.empty() ? ".Fl -" : " ,\n.Fl -") + option->get_lnames().front();
    }
    if (!list.empty()) text += ".Bl -tag -width Ds\n" + list + ".El\n";
    for (const auto& [other, options] : described)
      if (!options.empty()) text += ".Pp\nAs for\n.Cm " + other + " :\n" + options + " .\n";
    for (const Paragraph& paragraph : paragraphs_of(command->get_footer()))
      if (program.get_footer().find(paragraph.text) == std::string::npos)
        text +=
            ".Pp\n" + (paragraph.title.empty() ? "" : paragraph.title + ":\n") + body_of(paragraph);
  }
  return text;
}

std::string part(const CLI::App& program, const std::string& name) {
  if (name == "synopsis") return synopsis(program);
  if (name == "options") return options_section(program);
  for (const Paragraph& paragraph : paragraphs_of(program.get_footer()))
    if (name_of(paragraph) == name) return body_of(paragraph);
  throw Error(ErrorCode::kBadFile,
              "the help of " + program.get_name() + " has no \"" + name + "\"");
}

}  // namespace

std::string manual_page(const CLI::App& program, std::string_view text) {
  std::string page;
  std::istringstream lines{std::string(text)};
  for (std::string line; std::getline(lines, line);)
    page += line.size() > 2 && line.starts_with('@') && line.ends_with('@')
                ? part(program, line.substr(1, line.size() - 2))
                : line + "\n";
  return page;
}

std::optional<std::string> asked_manual_page(const CLI::App& program,
                                             const std::vector<std::string>& arguments) {
  if (arguments.size() != 2 || arguments.front() != "--manual-page") return std::nullopt;
  return manual_page(program, os::read_file(arguments.back()));
}

}  // namespace tether::app
