#include "classify.h"

/// Instructions of 64-bit ARM, by the encoding index of the Arm Architecture Reference Manual
/// (DDI 0487, C4). A table is searched from its first row.
namespace tether::counter {
namespace {

using enum WorkClass;

struct Pattern {
  std::uint32_t mask;
  std::uint32_t bits;
  WorkClass work;
};

// Loads and stores (C4.1.94), most special first.
constexpr Pattern kMemory[] = {
    {0x3f800000, 0x08800000, kLoad},    // ordered; stores are told apart below
    {0x3f000000, 0x08000000, kAtomic},  // exclusive, compare and swap
    {0x3b200c00, 0x38200000, kAtomic},  // atomic memory operations
    {0x3b000000, 0x18000000, kLoad},    // literal
};

// Floating point and vectors (C4.1.95, C4.1.96), most special first.
constexpr Pattern kVector[] = {
    {0xff20fc00, 0x1e201800, kDivide},       // FDIV, scalar
    {0xff3ffc00, 0x1e21c000, kDivide},       // FSQRT, scalar
    {0x5f000000, 0x1e000000, kScalarFloat},  // scalar, conversions, moves
    {0x5f000000, 0x1f000000, kScalarFloat},  // FMADD and its kin
    {0xbfa0fc00, 0x2e20fc00, kDivide},       // FDIV, vector
    {0xbfbffc00, 0x2ea1f800, kDivide},       // FSQRT, vector
    {0x9f20c400, 0x0e20c400, kVectorFloat},  // three registers, opcode 11xxx
    {0x9f3f8c00, 0x0e218800, kVectorFloat},  // two registers, opcode 11xxx
    {0x9fbfcc00, 0x0ea0c800, kVectorFloat},  // compared with zero, absolute value
    {0x9f3fec00, 0x0e216800, kVectorFloat},  // FCVTN, FCVTL
    {0x9f80fc00, 0x0f00e400, kVectorFloat},  // SCVTF of fixed point
    {0x9f80fc00, 0x0f00fc00, kVectorFloat},  // FCVTZ to fixed point
    {0x9f80b400, 0x0f801000, kVectorFloat},  // FMLA, FMLS by element
    {0x9f80f400, 0x0f809000, kVectorFloat},  // FMUL by element
};

template <std::size_t N>
const Pattern* find(const Pattern (&table)[N], std::uint32_t instruction) {
  for (const Pattern& row : table)
    if ((instruction & row.mask) == row.bits) return &row;
  return nullptr;
}

WorkClass memory(std::uint32_t i) {
  const bool is_load_bit_set = (i & 1u << 22) != 0;
  if (const Pattern* found = find(kMemory, i)) {
    const bool is_ordered = found == &kMemory[0] && (i & 1u << 21) == 0;
    if (found == &kMemory[0] && !is_ordered) return kAtomic;  // CAS
    return is_ordered && !is_load_bit_set ? kStore : found->work;
  }
  // One register: opc 00 is a store; 10 too, of a vector register of 128 bits.
  if ((i & 0x3a000000) == 0x38000000) {
    const std::uint32_t opc = i >> 22 & 3, is_vector = i >> 26 & 1;
    return opc == 0 || (opc == 2 && is_vector) ? kStore : kLoad;
  }
  return is_load_bit_set ? kLoad : kStore;  // pairs, structures of vectors
}

WorkClass computation(std::uint32_t i) {
  if ((i & 0x1f000000) == 0x1b000000) return kMultiply;
  if ((i & 0x5fe0f800) == 0x1ac00800) return kDivide;
  return kInteger;
}

WorkClass vector(std::uint32_t i) {
  const bool is_one_element = (i & 0x5e000000) == 0x5e000000;
  // Computation on one element of a vector register has bits 28 and 30 set.
  const Pattern* found = find(kVector, is_one_element ? i & ~0x50000000u : i);
  if (!found) return kVectorInteger;
  return is_one_element && found->work == kVectorFloat ? kScalarFloat : found->work;
}

// SVE: the three highest bits.
WorkClass scalable(std::uint32_t i) {
  constexpr WorkClass kWork[] = {kVectorInteger, kVectorInteger, kVectorInteger, kVectorFloat,
                                 kLoad,          kLoad,          kLoad,          kStore};
  return kWork[i >> 29];
}

WorkClass work_of(std::uint32_t i) {
  const std::uint32_t group = i >> 25 & 0xf;
  if ((group & 0b0101) == 0b0100) return memory(i);
  if ((group & 0b0111) == 0b0101) return computation(i);
  if ((group & 0b0111) == 0b0111) return vector(i);
  if (group == 0b0010) return scalable(i);
  const bool is_system = (i & 0xff000000) == 0xd5000000;
  return (group & 0b1110) == 0b1010 && !is_system ? kBranch : kInteger;
}

}  // namespace

void add_aarch64(std::uint32_t instruction, Work& work) {
  ++work[static_cast<std::size_t>(work_of(instruction))];
}

}  // namespace tether::counter
