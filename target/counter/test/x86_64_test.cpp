
#include "classify.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>

namespace tether::counter {
namespace {

using enum WorkClass;

struct Case {
  std::string instruction;
  std::vector<std::uint8_t> bytes;
  std::vector<WorkClass> work;
};

TEST(X8664, TellsTheWorkOfAnInstructionFromItsBytes) {
  const std::vector<Case> cases = {
      {"add %rax,%rbx", {0x48, 0x01, 0xc3}, {kInteger}},
      {"add %rax,(%rbx)", {0x48, 0x01, 0x03}, {kInteger, kLoad, kStore}},
      {"add (%rbx),%rax", {0x48, 0x03, 0x03}, {kInteger, kLoad}},
      {"cmp %rax,(%rbx)", {0x48, 0x39, 0x03}, {kInteger, kLoad}},
      {"cmpl $1,(%rbx)", {0x83, 0x3b, 0x01}, {kInteger, kLoad}},
      {"addl $1,(%rbx)", {0x83, 0x03, 0x01}, {kInteger, kLoad, kStore}},
      {"add $0x1,%al", {0x04, 0x01}, {kInteger}},
      {"mov (%rdi),%rax", {0x48, 0x8b, 0x07}, {kLoad}},
      {"mov %rax,(%rdi)", {0x48, 0x89, 0x07}, {kStore}},
      {"mov %rax,%rdi", {0x48, 0x89, 0xc7}, {kInteger}},
      {"mov $1,%al", {0xb0, 0x01}, {kInteger}},
      {"movl $1,(%rdi)", {0xc7, 0x07, 1, 0, 0, 0}, {kStore}},
      {"movzbl (%rdi),%eax", {0x0f, 0xb6, 0x07}, {kLoad}},
      {"lea 8(%rdi),%rax", {0x48, 0x8d, 0x47, 0x08}, {kInteger}},
      {"nopw 0(%rax)", {0x66, 0x0f, 0x1f, 0x00}, {kInteger}},
      {"push %rbp", {0x55}, {kStore}},
      {"pop %r12", {0x41, 0x5c}, {kLoad}},
      {"call", {0xe8, 0, 0, 0, 0}, {kBranch, kStore}},
      {"call *(%rax)", {0xff, 0x10}, {kBranch, kLoad, kStore}},
      {"ret", {0xc3}, {kBranch, kLoad}},
      {"je", {0x74, 0x05}, {kBranch}},
      {"je, far", {0x0f, 0x84, 1, 0, 0, 0}, {kBranch}},
      {"jmp *%rax", {0xff, 0xe0}, {kBranch}},
      {"imul %rbx,%rax", {0x48, 0x0f, 0xaf, 0xc3}, {kMultiply}},
      {"mul (%rbx)", {0x48, 0xf7, 0x23}, {kMultiply, kLoad}},
      {"div %ecx", {0xf7, 0xf1}, {kDivide}},
      {"neg %eax", {0xf7, 0xd8}, {kInteger}},
      {"lock xadd %eax,(%rdi)", {0xf0, 0x0f, 0xc1, 0x07}, {kAtomic}},
      {"xchg %eax,(%rdi)", {0x87, 0x07}, {kAtomic}},
      {"xchg %eax,%edi", {0x87, 0xc7}, {kInteger}},
      {"rep stos", {0xf3, 0x48, 0xab}, {kStore}},
      {"movsq", {0x48, 0xa5}, {kLoad, kStore}},
      {"addsd %xmm1,%xmm0", {0xf2, 0x0f, 0x58, 0xc1}, {kScalarFloat}},
      {"addpd %xmm1,%xmm0", {0x66, 0x0f, 0x58, 0xc1}, {kVectorFloat}},
      {"addps (%rdi),%xmm0", {0x0f, 0x58, 0x07}, {kVectorFloat, kLoad}},
      {"divss %xmm1,%xmm0", {0xf3, 0x0f, 0x5e, 0xc1}, {kDivide}},
      {"sqrtpd %xmm1,%xmm0", {0x66, 0x0f, 0x51, 0xc1}, {kDivide}},
      {"ucomisd %xmm1,%xmm0", {0x66, 0x0f, 0x2e, 0xc1}, {kScalarFloat}},
      {"cvtsi2sd %eax,%xmm0", {0xf2, 0x0f, 0x2a, 0xc0}, {kScalarFloat}},
      {"cvttps2dq %xmm1,%xmm0", {0xf3, 0x0f, 0x5b, 0xc1}, {kVectorFloat}},
      {"movups (%rdi),%xmm0", {0x0f, 0x10, 0x07}, {kLoad}},
      {"movaps %xmm0,(%rdi)", {0x0f, 0x29, 0x07}, {kStore}},
      {"movaps %xmm1,%xmm0", {0x0f, 0x28, 0xc1}, {kVectorInteger}},
      {"movq (%rdi),%xmm0", {0xf3, 0x0f, 0x7e, 0x07}, {kLoad}},
      {"movd %xmm0,(%rdi)", {0x66, 0x0f, 0x7e, 0x07}, {kStore}},
      {"paddb (%rdi),%xmm0", {0x66, 0x0f, 0xfc, 0x07}, {kVectorInteger, kLoad}},
      {"pshufb %xmm1,%xmm0", {0x66, 0x0f, 0x38, 0x00, 0xc1}, {kVectorInteger}},
      {"vpaddd %ymm2,%ymm1,%ymm0", {0xc5, 0xf5, 0xfe, 0xc2}, {kVectorInteger}},
      {"vaddps (%rdi),%ymm1,%ymm0", {0xc5, 0xf4, 0x58, 0x07}, {kVectorFloat, kLoad}},
      {"vfmadd231ps %ymm2,%ymm1,%ymm0", {0xc4, 0xe2, 0x75, 0xb8, 0xc2}, {kVectorFloat}},
      {"vfmadd231sd %xmm2,%xmm1,%xmm0", {0xc4, 0xe2, 0xf1, 0xb9, 0xc2}, {kScalarFloat}},
      {"vpbroadcastb (%rdi),%ymm0", {0xc4, 0xe2, 0x7d, 0x78, 0x07}, {kLoad}},
      {"fldt (%rdi)", {0xdb, 0x2f}, {kScalarFloat, kLoad}},
      {"syscall", {0x0f, 0x05}, {kBranch}},
      {"too short", {0x0f}, {kInteger}},
  };
  for (const Case& c : cases) {
    Work expected{}, work{};
    for (const WorkClass kind : c.work) ++expected[static_cast<std::size_t>(kind)];
    add_x86_64(c.bytes, work);
    EXPECT_EQ(work, expected) << c.instruction;
  }
}

}  // namespace
}  // namespace tether::counter
