#include "shared/help.h"

#include "shared/value.h"

#include <algorithm>
#include <string>

#include <tether/base/text.h>

namespace tether::app {

namespace {

class Format : public CLI::Formatter {
 public:
  explicit Format(std::size_t columns) : columns_(columns) { label("Positionals", "Arguments"); }

  std::string make_option(const CLI::Option* option, bool is_positional) const override {
    std::string name = is_positional ? option->get_name(true) : option->get_name(false, true);
    if (!is_positional && takes_value(*option)) name += " " + value_of(*option).word;
    if (is_list(*option)) name += " ...";
    return entry(name, text_of(*option));
  }
  std::string make_subcommand(const CLI::App* command) const override {
    return entry(command->get_name(), command->get_description());
  }
  std::string make_description(const CLI::App* app) const override {
    return paragraphs(app->get_description() + "\n");
  }
  std::string make_footer(const CLI::App* app) const override {
    return paragraphs(app->get_footer() + "\n");
  }

 private:
  /// Where a paragraph is broken in the source says nothing: only blanks begin a line of its own.
  std::string paragraphs(std::string text) const {
    for (std::size_t i = 1; i + 1 < text.size(); ++i)
      if (text[i] == '\n' && text[i - 1] != '\n' && text[i - 1] != ':' && text[i + 1] != '\n' &&
          text[i + 1] != ' ')
        text[i] = ' ';
    return wrapped(text, columns_);
  }
  /// On a narrow terminal, the text begins on a line of its own.
  std::string entry(const std::string& name, const std::string& text) const {
    const std::size_t begin = columns_ < 80 ? 6 : 26;
    const std::string left = "  " + name;
    const std::string room(begin, ' ');
    if (columns_of(left) + 2 > begin) return left + "\n" + wrapped(room + text, columns_) + "\n";
    return wrapped(left + room.substr(columns_of(left)) + text, columns_) + "\n";
  }

  std::size_t columns_;
};

}  // namespace

std::shared_ptr<CLI::FormatterBase> help_format(std::size_t columns) {
  return std::make_shared<Format>(columns);
}

}  // namespace tether::app
