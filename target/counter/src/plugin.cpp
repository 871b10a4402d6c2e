#include "classify.h"
#include "turns.h"

#include <atomic>
#include <cstdio>
#include <cstring>
#include <numeric>
#include <string_view>

#include <fcntl.h>
#include <pthread.h>
#include <sys/mman.h>
#include <unistd.h>

#include <tether/base/count_page.h>

/// A plugin of qemu-user: counts the work of the emulated program in the page that the program's
/// client library reads. Counting is an addition for each translated block that begins.
///
/// What it uses of QEMU's interface for plugins (version 1 of 4.2 and later) is declared here, for
/// no package has the header.
extern "C" {

// NOLINTBEGIN(readability-identifier-naming): QEMU's names
struct qemu_plugin_tb;
struct qemu_plugin_insn;
struct qemu_info_t {
  const char* target_name;
  struct {
    int min;
    int cur;
  } version;
  bool system_emulation;
};
using qemu_plugin_id_t = std::uint64_t;

void qemu_plugin_register_vcpu_tb_trans_cb(qemu_plugin_id_t,
                                           void (*)(qemu_plugin_id_t, qemu_plugin_tb*));
std::size_t qemu_plugin_tb_n_insns(const qemu_plugin_tb*);
qemu_plugin_insn* qemu_plugin_tb_get_insn(const qemu_plugin_tb*, std::size_t);
const void* qemu_plugin_insn_data(const qemu_plugin_insn*);
std::size_t qemu_plugin_insn_size(const qemu_plugin_insn*);
void qemu_plugin_register_vcpu_tb_exec_inline(qemu_plugin_tb*, int operation, void*, std::uint64_t);
void qemu_plugin_register_vcpu_init_cb(qemu_plugin_id_t, void (*)(qemu_plugin_id_t, unsigned));
void qemu_plugin_register_vcpu_syscall_cb(qemu_plugin_id_t,
                                          void (*)(qemu_plugin_id_t, unsigned, std::int64_t number,
                                                   std::uint64_t, std::uint64_t, std::uint64_t,
                                                   std::uint64_t, std::uint64_t, std::uint64_t,
                                                   std::uint64_t, std::uint64_t));
void qemu_plugin_register_vcpu_syscall_ret_cb(qemu_plugin_id_t,
                                              void (*)(qemu_plugin_id_t, unsigned, std::int64_t,
                                                       std::int64_t));

extern __attribute__((visibility("default"))) const int qemu_plugin_version;
const int qemu_plugin_version = 1;
__attribute__((visibility("default"))) int qemu_plugin_install(qemu_plugin_id_t, const qemu_info_t*,
                                                               int, char**);
// NOLINTEND(readability-identifier-naming)

}  // extern "C"

namespace tether::counter {
namespace {

constexpr int kAddU64 = 0;  // QEMU_PLUGIN_INLINE_ADD_U64

CountPage* page = nullptr;
bool is_arm = false;
/// Made at the start and never destroyed: threads use it until the process ends.
Turns* turns = nullptr;

void add(const qemu_plugin_insn* instruction, Work& work) {
  const auto* bytes = static_cast<const std::uint8_t*>(qemu_plugin_insn_data(instruction));
  if (is_arm) {
    std::uint32_t word = 0;
    std::memcpy(&word, bytes, sizeof word);
    add_aarch64(word, work);
  } else {
    add_x86_64({bytes, qemu_plugin_insn_size(instruction)}, work);
  }
}

std::uint64_t cost_of(const Work& work) {
  return std::inner_product(work.begin(), work.end(), page->cost_units.begin(), std::uint64_t{0});
}

// One addition for each block. An addition after each instruction that can fault would count
// exactly what is executed of a block, but makes the program run 1.4 times as long.
void translated(qemu_plugin_id_t, qemu_plugin_tb* block) {
  Work work{};
  const std::size_t instructions = qemu_plugin_tb_n_insns(block);
  for (std::size_t k = 0; k < instructions; ++k) add(qemu_plugin_tb_get_insn(block, k), work);
  const auto add_to = [&](std::atomic<std::uint64_t>& sum, std::uint64_t amount) {
    if (amount > 0) qemu_plugin_register_vcpu_tb_exec_inline(block, kAddU64, &sum, amount);
  };
  if (page->has_costs()) return add_to(page->units, cost_of(work));
  for (std::size_t kind = 0; kind < work.size(); ++kind) add_to(page->counts[kind], work[kind]);
}

void began(qemu_plugin_id_t, unsigned thread) {
  turns->begins(thread);
}

void enters_kernel(qemu_plugin_id_t, unsigned thread, std::int64_t number, std::uint64_t first,
                   std::uint64_t second, std::uint64_t, std::uint64_t, std::uint64_t, std::uint64_t,
                   std::uint64_t, std::uint64_t) {
  turns->enters_kernel(thread, system_call(is_arm, number, first, second));
}

void leaves_kernel(qemu_plugin_id_t, unsigned thread, std::int64_t, std::int64_t result) {
  turns->leaves_kernel(thread, result);
}

int refuse(const char* what, std::string_view subject) {
  std::fprintf(stderr, "tether-counter: %s (found \"%.*s\")\n", what,
               static_cast<int>(subject.size()), subject.data());
  return 1;
}

CountPage* map_page(const char* file) {
  const int descriptor = ::open(file, O_RDWR | O_CLOEXEC);
  if (descriptor < 0) return nullptr;
  void* const mapped =
      ::mmap(nullptr, sizeof(CountPage), PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
  ::close(descriptor);
  return mapped == MAP_FAILED ? nullptr : static_cast<CountPage*>(mapped);
}

int install(qemu_plugin_id_t id, const qemu_info_t& info, std::string_view argument) {
  const std::string_view machine = info.target_name;
  is_arm = machine == "aarch64";
  if (!is_arm && machine != "x86_64")
    return refuse("only programs for x86_64 and aarch64 can be counted", machine);
  constexpr std::string_view kPage = "page=";
  if (!argument.starts_with(kPage)) return refuse("page=FILE is needed", argument);
  page = map_page(argument.substr(kPage.size()).data());
  if (!page) return refuse("the page cannot be mapped", argument);
  if (page->magic != CountPage::kMagic || page->version != CountPage::kVersion ||
      page->classes != kWorkClasses)
    return refuse("the page is of another version of Tether", argument);
  turns = new Turns(*page);
  ::pthread_atfork([] { turns->mutex().lock(); }, [] { turns->mutex().unlock(); },
                   [] { turns->mutex().unlock(); });
  qemu_plugin_register_vcpu_init_cb(id, began);
  qemu_plugin_register_vcpu_tb_trans_cb(id, translated);
  qemu_plugin_register_vcpu_syscall_cb(id, enters_kernel);
  qemu_plugin_register_vcpu_syscall_ret_cb(id, leaves_kernel);
  page->plugin_version.store(CountPage::kVersion);
  return 0;
}

}  // namespace
}  // namespace tether::counter

int qemu_plugin_install(qemu_plugin_id_t id, const qemu_info_t* info, int argc, char** argv) {
  return tether::counter::install(id, *info, argc == 1 ? argv[0] : "");
}
