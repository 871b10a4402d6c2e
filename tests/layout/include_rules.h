#pragma once

#include "source_tree.h"

#include <map>
#include <set>
#include <string>
#include <vector>

/// What may include what (docs/design.md, section 4). Each check returns one line per breach:
/// "path:line: what".
namespace tether::layout {

/// The arrows: each library with the libraries that it may include. A library that is missing here
/// is itself a breach.
const std::map<std::string, std::set<std::string>>& allowed_dependencies();

/// Includes between libraries follow the arrows; nothing includes apps, tests or bench.
std::vector<std::string> check_arrows(const std::vector<SourceFile>& files);

/// No library depends on itself through others, whatever the table says.
std::vector<std::string> check_cycles(const std::vector<SourceFile>& files);

/// Public headers include the standard library and Tether only, begin with #pragma once, and quote
/// nothing.
std::vector<std::string> check_public_headers(const std::vector<SourceFile>& files);

/// A quoted include names a file of the same library or program, without "..". Benchmarks and
/// tests/ may quote any.
std::vector<std::string> check_private_headers(const std::vector<SourceFile>& files);

/// `sync` holds no socket, thread, clock read, sleep, file or log.
std::vector<std::string> check_sync_is_pure(const std::vector<SourceFile>& files);

/// `coordinator` names no task and no back end.
std::vector<std::string> check_coordinator_is_neutral(const std::vector<SourceFile>& files);

/// Product code draws random numbers by key (base/random.h), never from a generator with a state or
/// from the machine; only the link's token may come from the machine.
std::vector<std::string> check_randomness(const std::vector<SourceFile>& files);

}  // namespace tether::layout
