#include "fuzz_target.h"

#include <stdexcept>
#include <vector>

#include <tether/os/text_file.h>
#include <tether/sim/file_cache.h>
#include <tether/sim/world_parts.h>

/// What the cache of worlds reads. Input: a letter, then bytes. W: the content of an entry with a
/// world. E: changes of an entry's file, each a place, two bytes long, and a byte; the first place
/// is the file's new length. Others: the file itself.
namespace tether::fuzz {
namespace {

using sim::FileCache;

constexpr std::string_view kKey = "the key of an entry";

void read_world(std::string_view bytes) try {
  std::map<std::pair<std::filesystem::path, bool>, sim::FileState> answers;
  sim::World world;
  std::vector<Warning> warnings;
  sim::ByteReader in(bytes);
  in(answers, world, warnings);
  sim::ByteWriter out;
  out(answers, world, warnings);
  require(!out.take().empty(), "a world without bytes");
} catch (const std::out_of_range&) {  // as it should
}

std::filesystem::path only_file_in(const std::filesystem::path& folder) {
  return std::filesystem::directory_iterator(folder)->path();
}

std::string changed(std::string entry, Choices choices) {
  const auto place = [&] { return choices.byte() * std::size_t{256} + choices.byte(); };
  entry.resize(place() % (entry.size() + 100));
  while (!choices.empty() && !entry.empty())
    entry[place() % entry.size()] = static_cast<char>(choices.byte());
  return entry;
}

void find_entry(const InputFolder& folder, const std::string& name, std::string_view content) {
  folder.write(name, content);
  const FileCache::Parts found = FileCache(folder.path()).find(kKey);
  if (found == nullptr) return;
  std::size_t sum = 0;
  for (const std::string_view part : *found) {
    require(reinterpret_cast<std::uintptr_t>(part.data()) % 64 == 0, "a part between boundaries");
    for (const char c : part) sum += static_cast<unsigned char>(c);
  }
  require(sum < content.size() * 256, "more than the file has");
}

}  // namespace
}  // namespace tether::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tether;
  static const fuzz::InputFolder folder;
  static const std::string entry = [] {
    const std::vector<std::string_view> parts{"checked", std::string_view(), "not checked"};
    sim::FileCache(folder.path()).keep(fuzz::kKey, parts, 2);
    return os::read_file(fuzz::only_file_in(folder.path()), 10000);
  }();
  static const std::string name = fuzz::only_file_in(folder.path()).filename();
  fuzz::Choices choices({data, size});
  const std::uint8_t kind = choices.byte();
  const std::string bytes = fuzz::text_of(choices.rest());
  if (kind == 'W') {
    fuzz::read_world(bytes);
  } else {
    fuzz::find_entry(folder, name, kind == 'E' ? fuzz::changed(entry, choices) : bytes);
  }
  return 0;
}
