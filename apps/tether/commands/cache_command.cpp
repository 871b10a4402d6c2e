#include "commands/commands.h"
#include "terminal/print.h"

#include <optional>

#include <fmt/format.h>

#include <tether/base/text.h>
#include <tether/sim/file_cache.h>

namespace tether::app {
namespace {

struct CacheOptions {
  bool clear = false;
};

/// Prints where worlds are kept, and how many.
int show_cache(const CacheOptions& options, const std::stop_token&) {
  const std::optional<sim::FileCache> cache = sim::FileCache::of_user();
  if (!cache) {
    print("worlds are not kept: TETHER_CACHE is \"off\", or there is no home folder\n");
    return 0;
  }
  if (options.clear) cache->clear();
  const sim::FileCache::Size size = cache->size();
  print(fmt::format("{}: {}, {:.1f} MB of at most {:.0f} MB\n", cache->folder().string(),
                    counted(size.entries, "file"), 1e-6 * static_cast<double>(size.bytes),
                    1e-6 * static_cast<double>(cache->most_bytes())));
  cache->require_writable();
  return 0;
}

Options cache_rows(CacheOptions& o) {
  return {{"--clear", "Remove all files in it", &o.clear}};
}

}  // namespace

Command cache_command() {
  return make_command(
      "cache", "Show the folder in which worlds are kept that were read once", cache_rows,
      R"(Commands find a world there that they have read before, unless a file of it changed. Set
the environment variable TETHER_CACHE to another folder, or to "off".

Exit codes: 0 worlds can be kept, or are not to be; 2 wrong use; 3 they cannot be kept.

Examples:
  tether cache
  tether cache --clear)",
      show_cache);
}

}  // namespace tether::app
