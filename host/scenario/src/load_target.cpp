#include <algorithm>
#include <array>
#include <cctype>

#include <fmt/format.h>

#include <tether/scenario/target.h>
#include <tether/toml/table.h>

namespace tether::scenario {
namespace {

constexpr std::array<std::string_view, 2> kTargetClocks = {"wall", "cpu"};
constexpr std::int64_t kMostCores = 4096;

/// What a name must have to become a folder's.
bool has_letter_or_digit(const std::string& name) {
  return std::any_of(name.begin(), name.end(),
                     [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; });
}

std::optional<SshAddress> read_address(const toml::Table& root) {
  if (!root.has("address")) return std::nullopt;
  const std::string address = root.text("address");
  try {
    return parse_ssh_address(address);
  } catch (const Error& error) {
    root.fail("address", fmt::format("is \"{}\"; {}", address, error.what()));
  }
}

/// A board is measured, not made slower, and its cores are its own.
void reject_what_a_board_has_itself(const toml::Table& root, const Target& target) {
  if (target.clock == Clock::kCpu) {
    root.fail("clock",
              "is \"cpu\", which is for virtual targets; with an address the board's own \"wall\" "
              "clock counts");
  }
  if (root.has("cpu_factor")) {
    root.fail("cpu_factor", "makes a virtual target, and so does not go with an address");
  }
  if (root.has("cores")) {
    root.fail("cores", "is of this host, and so does not go with an address");
  }
}

std::string beside(const Target& target, const std::string& path) {
  return (target.file.parent_path() / path).lexically_normal().string();
}

/// Words that begin with "./" or "../" are files beside the target's, as in `-L ../sysroot`.
std::vector<std::string> read_launcher(const toml::Table& root, const Target& target) {
  std::vector<std::string> words = root.texts_or_none("launcher");
  if (root.has("launcher") && words.empty()) {
    root.fail("launcher", "must name a program, but is empty");
  }
  for (std::string& word : words) {
    const bool is_relative = word.starts_with("./") || word.starts_with("../");
    if (is_relative && !target.ssh) word = beside(target, word);
  }
  return words;
}

/// What is on a board shows when it is asked. Of this host it need not be there yet either: what
/// builds the programs may come after the file.
std::string read_program_folder(const toml::Table& root, const Target& target) {
  const std::string folder = root.text_or("program_folder", "");
  return folder.empty() || target.ssh ? folder : beside(target, folder);
}

}  // namespace

Target load_target(const std::filesystem::path& file) {
  constexpr toml::Range kFactor{.min = 1e-3, .max = 1e4};
  Target target;
  target.file = std::filesystem::absolute(file).lexically_normal();
  const toml::Document document = toml::Document::load(target.file);
  const toml::Table root = document.root({"name", "description", "address", "clock", "cpu_factor",
                                          "cores", "launcher", "program_folder"});
  target.name = root.identifier("name");
  if (!has_letter_or_digit(target.name)) root.fail("name", "must contain a letter or a digit");
  target.description = root.text_or("description", "");
  target.ssh = read_address(root);
  if (root.has("clock")) {
    target.clock = root.choice("clock", kTargetClocks) == 0 ? Clock::kWall : Clock::kCpu;
  }
  if (target.ssh) reject_what_a_board_has_itself(root, target);
  target.cpu_factor = root.number_or("cpu_factor", kFactor, 1.0);
  target.cores = static_cast<int>(root.integer_or("cores", 1, kMostCores, 0));
  target.launcher = read_launcher(root, target);
  target.program_folder = read_program_folder(root, target);
  return target;
}

}  // namespace tether::scenario
