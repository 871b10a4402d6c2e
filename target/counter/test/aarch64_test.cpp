
#include "classify.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>

namespace tether::counter {
namespace {

using enum WorkClass;

struct Instruction {
  const char* text;
  std::uint32_t bits;
  WorkClass work;
};

// Encoded by GNU as.
TEST(Aarch64, TellsTheWorkOfAnInstructionFromItsBits) {
  constexpr Instruction kInstructions[] = {
      {"add x0, x1, x2", 0x8b020020, kInteger},
      {"add x0, x1, #0x4", 0x91001020, kInteger},
      {"adrp x0, 0", 0x90000000, kInteger},
      {"ldr x0, [x1]", 0xf9400020, kLoad},
      {"ldr x0, [x1, x2]", 0xf8626820, kLoad},
      {"ldp x0, x1, [sp], #16", 0xa8c107e0, kLoad},
      {"str x0, [x1, #8]", 0xf9000420, kStore},
      {"stp x0, x1, [sp, #-16]!", 0xa9bf07e0, kStore},
      {"ldr q0, [x1]", 0x3dc00020, kLoad},
      {"str q0, [x1]", 0x3d800020, kStore},
      {"ldur q0, [x1, #3]", 0x3cc03020, kLoad},
      {"str b0, [x1]", 0x3d000020, kStore},
      {"ldrsw x0, [x1]", 0xb9800020, kLoad},
      {"ldr x0, 34", 0x58000000, kLoad},
      {"ld4 {v0.16b-v3.16b}, [x0]", 0x4c400000, kLoad},
      {"st1 {v0.16b}, [x0]", 0x4c007000, kStore},
      {"ldaxr w0, [x1]", 0x885ffc20, kAtomic},
      {"stxr w2, w0, [x1]", 0x88027c20, kAtomic},
      {"ldar w0, [x1]", 0x88dffc20, kLoad},
      {"stlr w0, [x1]", 0x889ffc20, kStore},
      {"cas w0, w1, [x2]", 0x88a07c41, kAtomic},
      {"ldadd w0, w1, [x2]", 0xb8200041, kAtomic},
      {"mul x0, x1, x2", 0x9b027c20, kMultiply},
      {"madd w0, w1, w2, w3", 0x1b020c20, kMultiply},
      {"umulh x0, x1, x2", 0x9bc27c20, kMultiply},
      {"sdiv x0, x1, x2", 0x9ac20c20, kDivide},
      {"udiv w0, w1, w2", 0x1ac20820, kDivide},
      {"lsl x0, x1, x2", 0x9ac22020, kInteger},
      {"b 70", 0x14000000, kBranch},
      {"bl 74", 0x94000000, kBranch},
      {"cbz x0, 78", 0xb4000000, kBranch},
      {"ret", 0xd65f03c0, kBranch},
      {"br x1", 0xd61f0020, kBranch},
      {"svc #0x0", 0xd4000001, kBranch},
      {"nop", 0xd503201f, kInteger},
      {"dmb ish", 0xd5033bbf, kInteger},
      {"mrs x0, tpidr_el0", 0xd53bd040, kInteger},
      {"fadd d0, d1, d2", 0x1e622820, kScalarFloat},
      {"fmul s0, s1, s2", 0x1e220820, kScalarFloat},
      {"fmadd d0, d1, d2, d3", 0x1f420c20, kScalarFloat},
      {"fdiv d0, d1, d2", 0x1e621820, kDivide},
      {"fsqrt s0, s1", 0x1e21c020, kDivide},
      {"fcmp d0, d1", 0x1e612000, kScalarFloat},
      {"fmov d0, x1", 0x9e670020, kScalarFloat},
      {"scvtf d0, x0", 0x9e620000, kScalarFloat},
      {"scvtf d0, d1", 0x5e61d820, kScalarFloat},
      {"fcvtzs d0, d1", 0x5ee1b820, kScalarFloat},
      {"fadd v0.4s, v1.4s, v2.4s", 0x4e22d420, kVectorFloat},
      {"fmla v0.4s, v1.4s, v2.4s", 0x4e22cc20, kVectorFloat},
      {"fmla v0.4s, v1.4s, v2.s[1]", 0x4fa21020, kVectorFloat},
      {"fmul v0.4s, v1.4s, v2.s[1]", 0x4fa29020, kVectorFloat},
      {"fdiv v0.4s, v1.4s, v2.4s", 0x6e22fc20, kDivide},
      {"fsqrt v0.2d, v1.2d", 0x6ee1f820, kDivide},
      {"fcmgt v0.4s, v1.4s, #0.0", 0x4ea0c820, kVectorFloat},
      {"fabs v0.4s, v1.4s", 0x4ea0f820, kVectorFloat},
      {"scvtf v0.4s, v1.4s", 0x4e21d820, kVectorFloat},
      {"fcvtn v0.2s, v1.2d", 0x0e616820, kVectorFloat},
      {"add v0.16b, v1.16b, v2.16b", 0x4e228420, kVectorInteger},
      {"mla v0.8h, v1.8h, v2.h[1]", 0x6f520020, kVectorInteger},
      {"umin v0.16b, v1.16b, v2.16b", 0x6e226c20, kVectorInteger},
      {"and v0.16b, v1.16b, v2.16b", 0x4e221c20, kVectorInteger},
      {"ushr v0.8h, v1.8h, #3", 0x6f1d0420, kVectorInteger},
      {"xtn v0.8b, v1.8h", 0x0e212820, kVectorInteger},
      {"tbl v0.16b, {v1.16b}, v2.16b", 0x4e020020, kVectorInteger},
      {"dup v0.4s, w1", 0x4e040c20, kVectorInteger},
      {"umov w0, v0.b[1]", 0x0e033c00, kVectorInteger},
      {"umull v0.8h, v1.8b, v2.8b", 0x2e22c020, kVectorInteger},
      {"mul v0.8h, v1.8h, v2.8h", 0x4e629c20, kVectorInteger},
      {"addv b0, v1.16b", 0x4e31b820, kVectorInteger},
  };
  for (const Instruction& i : kInstructions) {
    Work expected{}, work{};
    expected[static_cast<std::size_t>(i.work)] = 1;
    add_aarch64(i.bits, work);
    EXPECT_EQ(work, expected) << i.text;
  }
}

}  // namespace
}  // namespace tether::counter
