#include "link_seeds.h"
#include "record_seeds.h"
#include "simulator_seeds.h"

#include <cstdio>

/// Writes the seeds of the targets whose inputs are no text: what honest programs send and write,
/// as this version of the product has it.
///   write_seeds FOLDER
int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: write_seeds FOLDER\n", stderr);
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  std::filesystem::remove_all(folder);
  tether::fuzz::write_link_seeds(folder);
  tether::fuzz::write_simulator_seeds(folder);
  tether::fuzz::write_record_seeds(folder);
  return 0;
}
