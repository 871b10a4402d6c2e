#include "engine.h"

#include "box_contacts.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>

#include <sys/mman.h>

#include <tether/base/error.h>

namespace tether::sim {
namespace {

std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

[[noreturn]] void raise_engine_error(const char* message) {
  throw Error(ErrorCode::kInternal, "MuJoCo: " + one_line(message));
}

// The simulator checks the counters of warnings in mjData instead.
void ignore_engine_warning(const char* /*message*/) {}

// Whether this thread was refused memory since it compiles a model: the compiler's message has no
// type.
thread_local bool out_of_memory = false;

// The engine clears its scratch memory (some 200 MB) once. By pages of 4 KiB, that takes a tenth of
// a second of each trial.
void* allocate_in_huge_pages(std::size_t size) {
  constexpr std::size_t kHugePage = std::size_t{2} << 20, kAligned = 64;
  const bool is_huge = size >= kHugePage;
  void* memory = nullptr;
  if (posix_memalign(&memory, is_huge ? kHugePage : kAligned, size) != 0) {
    out_of_memory = true;
    return nullptr;
  }
  if (is_huge) madvise(memory, size, MADV_HUGEPAGE);  // advice: without it, it is slower
  return memory;
}

// The engine's file system of fixed-size tables (2 MB), with one file.
class MemoryFile {
 public:
  MemoryFile(const char* name, const std::string& text) {
    if (text.size() > std::numeric_limits<int>::max()) {
      throw Error(ErrorCode::kBadFile,
                  "the meshes of its collisions have more vertices than MuJoCo takes: use simpler "
                  "meshes");
    }
    mj_defaultVFS(vfs_.get());
    mj_makeEmptyFileVFS(vfs_.get(), name, static_cast<int>(text.size()));
    std::ranges::copy(text, static_cast<char*>(vfs_->filedata[mj_findFileVFS(vfs_.get(), name)]));
  }
  ~MemoryFile() { mj_deleteVFS(vfs_.get()); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  const mjVFS* get() const { return vfs_.get(); }

 private:
  std::unique_ptr<mjVFS> vfs_ = std::make_unique<mjVFS>();
};

}  // namespace

void install_engine_handlers() {
  mju_user_error = raise_engine_error;
  mju_user_warning = ignore_engine_warning;
  mju_user_malloc = allocate_in_huge_pages;
  mju_user_free = std::free;
}

ModelPtr compile_model(const std::string& xml) {
  install_engine_handlers();
  install_box_contacts();
  constexpr const char* kName = "world.xml";
  const MemoryFile memory(kName, xml);
  out_of_memory = false;
  std::array<char, 1000> message{};
  ModelPtr model(mj_loadXML(kName, memory.get(), message.data(), static_cast<int>(message.size())));
  if (model) return model;
  if (out_of_memory) {
    throw Error(ErrorCode::kSetup, "MuJoCo: not enough memory for the world's model");
  }
  throw Error(ErrorCode::kBadFile, "MuJoCo cannot use the world: " + one_line(message.data()));
}

DataPtr make_data(const mjModel& model) {
  DataPtr data(mj_makeData(&model));
  if (!data) throw Error(ErrorCode::kSetup, "MuJoCo: not enough memory for the world's state");
  return data;
}

std::string engine_version() {
  return mj_versionString();
}

}  // namespace tether::sim
