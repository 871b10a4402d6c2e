#include "build_id.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <vector>

#include <elf.h>
#include <link.h>

#include <tether/link/codec.h>

namespace tether::client {
namespace {

std::string hexadecimal(const unsigned char* bytes, std::size_t count) {
  constexpr const char* kDigits = "0123456789abcdef";
  std::string digits;
  for (std::size_t i = 0; i < count; ++i) {
    digits += kDigits[bytes[i] >> 4];
    digits += kDigits[bytes[i] & 15];
  }
  return digits;
}

/// Of a segment of notes; empty: it is not there.
std::string find_build_id(const char* note, std::size_t size) {
  const auto padded = [](std::size_t bytes) { return (bytes + 3) / 4 * 4; };
  while (size >= sizeof(ElfW(Nhdr))) {
    ElfW(Nhdr) head;
    std::memcpy(&head, note, sizeof head);
    const std::size_t name = padded(head.n_namesz), content = padded(head.n_descsz);
    if (size < sizeof head + name + content) break;
    const char* const at = note + sizeof head;
    if (head.n_type == NT_GNU_BUILD_ID && head.n_namesz == 4 && std::memcmp(at, "GNU", 4) == 0) {
      const std::size_t most = link::kMaxBuildIdBytes / 2;
      return hexadecimal(reinterpret_cast<const unsigned char*>(at + name),
                         std::min<std::size_t>(head.n_descsz, most));
    }
    note = at + name + content;
    size -= sizeof head + name + content;
  }
  return "";
}

std::string build_id_of(const dl_phdr_info& object) {
  std::string id;
  for (int i = 0; i < object.dlpi_phnum && id.empty(); ++i) {
    const ElfW(Phdr)& segment = object.dlpi_phdr[i];
    if (segment.p_type != PT_NOTE) continue;
    // NOLINTNEXTLINE(performance-no-int-to-ptr): the loader gives addresses as numbers
    id = find_build_id(reinterpret_cast<const char*>(object.dlpi_addr + segment.p_vaddr),
                       segment.p_memsz);
  }
  return id;
}

/// The first object is the program.
int take_program(dl_phdr_info* object, std::size_t, void* out) {
  *static_cast<std::string*>(out) = build_id_of(*object);
  return 1;
}

/// The program and the kernel's part of it have no file name.
int take_library(dl_phdr_info* object, std::size_t, void* out) {
  const std::string file = object->dlpi_name != nullptr ? object->dlpi_name : "";
  if (file.find('/') != std::string::npos)
    static_cast<std::vector<LoadedLibrary>*>(out)->push_back({file, build_id_of(*object)});
  return 0;
}

}  // namespace

std::string build_id() {
  std::string id;
  ::dl_iterate_phdr(take_program, &id);
  return id;
}

std::vector<LoadedLibrary> loaded_libraries() {
  std::vector<LoadedLibrary> libraries;
  ::dl_iterate_phdr(take_library, &libraries);
  return libraries;
}

}  // namespace tether::client
