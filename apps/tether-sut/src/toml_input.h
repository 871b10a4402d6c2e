#pragma once

#include <string>

#include <toml++/toml.h>

#include <tether/base/result.h>

/// How this program reads the TOML files that people write: every mistake becomes one line that
/// names the file and the line in it.
namespace tether::sut {

/// What is wrong, on its way out of a reader that is given to `read_toml`.
struct BadInput {
  int line;
  std::string what;
};

int line_of(const toml::node& node);
int line_of(const toml::key& key);

/// The text of a file of at most 1 MiB. Fails (kInvalid): "PATH: cannot be read, or is no `what`".
Result<std::string> read_text(const std::string& path, const std::string& what);

/// "PATH:LINE: what", kInvalid.
Failure bad_input(const std::string& path, int line, const std::string& what);

/// What `read` makes of the file's table; it may throw BadInput.
template <class Value, class Read>
Result<Value> read_toml(const std::string& text, const std::string& path, Read read) {
  try {
    const toml::table file = toml::parse(text, path);
    return Value(read(file));
  } catch (const toml::parse_error& error) {
    return bad_input(path, static_cast<int>(error.source().begin.line),
                     "no valid TOML: " + std::string(error.description()));
  } catch (const BadInput& bad) {
    return bad_input(path, bad.line, bad.what);
  }
}

}  // namespace tether::sut
