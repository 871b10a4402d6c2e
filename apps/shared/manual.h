#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

namespace tether::app {

/// The manual page of a program, in mdoc(7), made of `text`: a page in which these lines stand for
/// what the program knows of itself:
///   @synopsis@  how each command is called
///   @options@   each command with its options and what the end of its help says
///   @TITLE@     the paragraph that the program's help begins with "TITLE:" or "TITLE (…):"
/// An option that several commands have alike is described for the first of them.
/// @throws Error(kBadFile) for another line of that form.
std::string manual_page(const CLI::App& program, std::string_view text);

/// The page, if a program is called with `--manual-page FILE`, which only its build does; of FILE's
/// text. @throws as manual_page, and as os::read_file.
std::optional<std::string> asked_manual_page(const CLI::App& program,
                                             const std::vector<std::string>& arguments);

}  // namespace tether::app
