#include "engine.h"

#include "box_contacts.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>

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

// The engine clears its scratch memory (some 200 MB) once. By pages of 4 KiB, that takes a tenth of
// a second of each trial.
void* allocate_in_huge_pages(std::size_t size) {
  constexpr std::size_t kHugePage = std::size_t{2} << 20, kAligned = 64;
  const bool is_huge = size >= kHugePage;
  void* memory = nullptr;
  if (posix_memalign(&memory, is_huge ? kHugePage : kAligned, size) != 0) return nullptr;
  if (is_huge) madvise(memory, size, MADV_HUGEPAGE);  // advice: without it, it is slower
  return memory;
}

// The engine's file system of fixed-size tables (2 MB).
class MemoryFiles {
 public:
  MemoryFiles() { mj_defaultVFS(vfs_.get()); }
  ~MemoryFiles() { mj_deleteVFS(vfs_.get()); }
  MemoryFiles(const MemoryFiles&) = delete;
  MemoryFiles& operator=(const MemoryFiles&) = delete;

  void add(const std::string& name, const char* bytes, std::size_t size) {
    if (mj_makeEmptyFileVFS(vfs_.get(), name.c_str(), static_cast<int>(size)) != 0) {
      throw Error(ErrorCode::kSetup, "MuJoCo: too many files in the model (at " + name + ")");
    }
    const int slot = mj_findFileVFS(vfs_.get(), name.c_str());
    std::memcpy(vfs_->filedata[slot], bytes, size);
  }
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

ModelPtr compile_model(const std::string& xml, const std::vector<ModelFile>& files) {
  install_engine_handlers();
  install_box_contacts();
  constexpr const char* kName = "world.xml";
  MemoryFiles memory;
  memory.add(kName, xml.data(), xml.size());
  for (const ModelFile& file : files) {
    memory.add(file.name, file.bytes.data(), file.bytes.size());
  }
  std::array<char, 1000> message{};
  ModelPtr model(mj_loadXML(kName, memory.get(), message.data(), static_cast<int>(message.size())));
  if (!model) {
    throw Error(ErrorCode::kSetup, "MuJoCo cannot use the world: " + one_line(message.data()));
  }
  return model;
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
