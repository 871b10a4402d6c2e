#include "shared/completion.h"

#include "shared/value.h"

#include <algorithm>
#include <functional>
#include <vector>

namespace tether::app {

namespace {

/// A command with the words that lead to it: "tether world check".
using Visit = std::function<void(const CLI::App& command, const std::string& words)>;

void visit(const CLI::App& command, const std::string& words, const Visit& of) {
  of(command, words);
  for (const CLI::App* sub : subcommands_of(command))
    visit(*sub, words + " " + sub->get_name(), of);
}

std::vector<const CLI::Option*> options_of(const CLI::App& command) {
  auto options = command.get_options([](const CLI::Option* o) { return o->nonpositional(); });
  std::erase_if(options, [](const CLI::Option* option) { return option->get_lnames().empty(); });
  return options;
}

std::string joined(const std::vector<std::string>& words, const std::string& gap = " ") {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : gap) + word;
  return text;
}

/// The first sentence, between single quotes.
std::string quoted(std::string text, const std::string& escaped_quote) {
  text = text.substr(0, text.find_first_of(".;:\n["));
  while (text.ends_with(' ')) text.pop_back();
  std::string out;
  for (const char c : text) out += c == '\'' ? escaped_quote : std::string(1, c);
  return "'" + out + "'";
}

/// The kind of shipped file that the command's first argument names; empty: none.
std::string shipped_kind(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options())
    for (const std::string kind : {"scenario", "campaign", "world"})
      if (!option->nonpositional() && option->get_name(true) == kind) return kind;
  return "";
}

/// The kind of shipped file that the value of an option names; empty: none.
std::string shipped_kind(const CLI::Option& option) {
  const std::string name = option.get_lnames().front();
  for (const char* kind : {"target", "profile", "world", "model"})
    if (name == kind) return kind;
  return "";
}

/// What a value can be, unless any text can.
std::vector<std::string> choices_of(const CLI::Option& option) {
  if (option.get_lnames().front() == "simulator") return {"mujoco", "gazebo"};
  return value_of(option).choices;
}

/// Shell code that prints the names below the heading "Scenarios" of `tether list`.
std::string list_names(const std::string& program, const std::string& kind) {
  return program + " list 2>/dev/null | awk 'tolower($1) == \"" + kind +
         "s\" {on = 1; next} /^[^ ]/ || !NF {on = 0} on && /^  [^ ]/ {print $1}'";
}

/// The parts of the scripts for bash and zsh, which follow the words in the same way.
struct Cases {
  std::string commands;  ///< patterns of words that lead to commands
  std::string values;    ///< cases of options with a value
  std::string words;     ///< cases of commands
};

/// @param of_choices, of_command: code of a case
Cases cases_of(const CLI::App& program,
               const std::function<std::string(const std::vector<std::string>&)>& of_choices,
               const std::function<std::string(const std::string&)>& of_kind,
               const std::string& of_files,
               const std::function<std::string(const CLI::App&)>& of_command) {
  Cases cases;
  std::vector<std::string> commands;
  visit(program, program.get_name(), [&](const CLI::App& command, const std::string& words) {
    if (&command != &program) commands.push_back("'" + words + "'");
    std::vector<std::string> with_files;
    for (const CLI::Option* option : options_of(command)) {
      if (!takes_value(*option)) continue;
      const std::string pattern = "'" + words + " --" + option->get_lnames().front() + "'";
      if (const auto choices = choices_of(*option); !choices.empty())
        cases.values += "    " + pattern + ") " + of_choices(choices) + " ;;\n";
      else if (const std::string kind = shipped_kind(*option); !kind.empty())
        cases.values += "    " + pattern + ") " + of_kind(kind) + " ;;\n";
      else
        with_files.push_back(pattern);
    }
    if (!with_files.empty())
      cases.values += "    " + joined(with_files, "|") + ") " + of_files + " ;;\n";
    cases.words += "    '" + words + "') " + of_command(command) + " ;;\n";
  });
  cases.commands = joined(commands, "|");
  return cases;
}

std::string bash_script(const CLI::App& program) {
  const std::string& name = program.get_name();
  const Cases cases = cases_of(
      program, [](const auto& choices) { return "words='" + joined(choices) + "'"; },
      [&](const auto& kind) { return "words=\"$(" + list_names(name, kind) + ")\""; }, "return",
      [&](const CLI::App& command) {
        std::vector<std::string> words;
        for (const CLI::App* sub : subcommands_of(command)) words.push_back(sub->get_name());
        for (const CLI::Option* option : options_of(command))
          words.push_back("--" + option->get_lnames().front());
        for (const CLI::Option* option : command.get_options())
          if (!option->nonpositional())
            for (const std::string& choice : value_of(*option).choices) words.push_back(choice);
        std::string code = "words='" + joined(words) + "'";
        if (const std::string kind = shipped_kind(command); !kind.empty())
          code += "; [[ $word == -* ]] || words+=\" $(" + list_names(name, kind) + ")\"";
        return code;
      });
  std::string function = "_" + name;
  std::ranges::replace(function, '-', '_');
  return function + R"(() {
  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} words= command=)" +
         name + R"( i
  for ((i = 1; i < COMP_CWORD; i++)); do
    case "$command ${COMP_WORDS[i]}" in
      )" +
         cases.commands +
         R"() command+=" ${COMP_WORDS[i]}" ;;
    esac
  done
  case "$command $before" in
)" + cases.values +
         R"(    *) case "$command" in
)" + cases.words +
         R"(    esac ;;
  esac
  COMPREPLY=($(compgen -W "$words" -- "$word"))
}
complete -o default -F )" +
         function + " " + name + "\n";
}

std::string zsh_script(const CLI::App& program) {
  const std::string& name = program.get_name();
  const auto described = [](const std::string& word, const std::string& text) {
    const std::string shown = quoted(text, "'\\''");
    return "'" + word + ":" + shown.substr(1);
  };
  const Cases cases = cases_of(
      program, [](const auto& choices) { return "compadd -- " + joined(choices) + "; return"; },
      [&](const auto& kind) {
        return "compadd -- ${(f)\"$(" + list_names(name, kind) + ")\"}; _files; return";
      },
      "_files; return",
      [&](const CLI::App& command) {
        std::vector<std::string> options, commands;
        for (const CLI::Option* option : options_of(command))
          options.push_back(
              described("--" + option->get_lnames().front(), option->get_description()));
        for (const CLI::App* sub : subcommands_of(command))
          commands.push_back(described(sub->get_name(), sub->get_description()));
        for (const CLI::Option* option : command.get_options())
          if (!option->nonpositional())
            for (const std::string& choice : value_of(*option).choices)
              commands.push_back("'" + choice + "'");
        std::string code = "options=(" + joined(options) + ") commands=(" + joined(commands) + ")";
        if (const std::string kind = shipped_kind(command); !kind.empty())
          code += "; commands+=(${(f)\"$(" + list_names(name, kind) + ")\"})";
        return code;
      });
  return "#compdef " + name + R"(
local command=)" +
         name + R"( word
local -a options commands
for word in ${words[2,CURRENT-1]}; do
  case "$command $word" in
    ()" + cases.commands +
         R"() command+=" $word" ;;
  esac
done
case "$command ${words[CURRENT-1]}" in
)" + cases.values +
         R"(esac
case "$command" in
)" + cases.words +
         R"(esac
if [[ $PREFIX == -* ]]; then
  _describe option options
else
  (( $#commands )) && _describe argument commands
  _files
fi
)";
}

/// The names as a command between double quotes.
std::string fish_names(const std::string& program, const std::string& kind) {
  std::string escaped;
  for (const char c : list_names(program, kind))
    escaped += c == '$' || c == '"' ? std::string{'\\', c} : std::string(1, c);
  return "\"(" + escaped + ")\"";
}

std::string fish_script(const CLI::App& program) {
  const std::string& name = program.get_name();
  std::string script;
  visit(program, name, [&](const CLI::App& command, const std::string&) {
    // The commands that lead here must be on the line, and none of those that lead further.
    std::vector<std::string> tests;
    for (const CLI::App* at = &command; at->get_parent() != nullptr; at = at->get_parent())
      tests.push_back("__fish_seen_subcommand_from " + at->get_name());
    std::vector<std::string> subs;
    for (const CLI::App* sub : subcommands_of(command)) subs.push_back(sub->get_name());
    if (!subs.empty()) tests.push_back("not __fish_seen_subcommand_from " + joined(subs));
    const std::string here =
        "complete -c " + name + (tests.empty() ? "" : " -n '" + joined(tests, "; and ") + "'");
    for (const CLI::App* sub : subcommands_of(command))
      script += here + " -f -a " + sub->get_name() + " -d " +
                quoted(sub->get_description(), "\\'") + "\n";
    for (const CLI::Option* option : options_of(command)) {
      script += here + " -l " + option->get_lnames().front();
      if (takes_value(*option)) script += " -r";
      if (const auto choices = choices_of(*option); !choices.empty())
        script += " -f -a '" + joined(choices) + "'";
      else if (const std::string kind = shipped_kind(*option); !kind.empty())
        script += " -a " + fish_names(name, kind);
      script += " -d " + quoted(option->get_description(), "\\'") + "\n";
    }
    for (const CLI::Option* option : command.get_options())
      if (const auto choices = value_of(*option).choices;
          !option->nonpositional() && !choices.empty())
        script += here + " -f -a '" + joined(choices) + "'\n";
    if (const std::string kind = shipped_kind(command); !kind.empty())
      script += here + " -a " + fish_names(name, kind) + "\n";
  });
  return script;
}

}  // namespace

std::string completion_script(const CLI::App& program, std::string_view shell) {
  return shell == "zsh"    ? zsh_script(program)
         : shell == "fish" ? fish_script(program)
                           : bash_script(program);
}

CLI::App* add_completion_command(CLI::App& program, std::string& shell) {
  CLI::App* command = program.add_subcommand(
      "completion", "Print the script with which a shell completes this program's words");
  command->add_option("shell", shell, "Which shell")
      ->required()
      ->check(CLI::IsMember(std::vector<std::string>(kShells.begin(), kShells.end())));
  const std::string& name = program.get_name();
  command->footer("The Debian packages install it. Otherwise, in ~/.bashrc:\n  eval \"$(" + name +
                  " completion bash)\"");
  return command;
}

}  // namespace tether::app
