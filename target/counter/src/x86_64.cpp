#include "classify.h"

#include <algorithm>
#include <optional>

/// Instructions of x86-64, by the opcode maps of the Intel manual (volume 2, appendix A). Tables
/// name ranges of opcodes and are searched from their first row.
namespace tether::counter {
namespace {

using enum WorkClass;
using Byte = std::uint8_t;

/// What an instruction does with its operand in memory, if it has one.
enum class Memory : Byte {
  kNone,     ///< computes its address only, or has a fixed use that is in `extra`
  kRead,     ///< load and work
  kLoads,    ///< a move: load, no work besides
  kStores,   ///< a move: store, no work besides
  kUpdates,  ///< load, work, store
};

/// Loads and stores in addition, of the stack or by fixed registers.
enum class Extra : Byte { kNone, kLoad, kStore };

struct Row {
  Byte first, last;
  WorkClass work;
  Memory memory = Memory::kRead;
  Extra extra = Extra::kNone;
};

using enum Memory;

constexpr Row kOneByte[] = {
    {0x38, 0x3d, kInteger},                       // cmp
    {0x50, 0x57, kStore, kNone},                  // push
    {0x58, 0x5f, kLoad, kNone},                   // pop
    {0x63, 0x63, kInteger, kLoads},               // movsxd
    {0x68, 0x68, kStore, kNone},                  // push
    {0x69, 0x69, kMultiply},                      // imul
    {0x6a, 0x6a, kStore, kNone},                  // push
    {0x6b, 0x6b, kMultiply},                      // imul
    {0x70, 0x7f, kBranch},                        // jcc
    {0x80, 0x83, kInteger, kUpdates},             // but cmp, see below
    {0x84, 0x85, kInteger},                       // test
    {0x86, 0x87, kInteger, kUpdates},             // xchg, atomic with memory
    {0x88, 0x89, kInteger, kStores},              // mov
    {0x8a, 0x8b, kInteger, kLoads},               // mov
    {0x8c, 0x8c, kInteger, kStores},              // mov of a segment register
    {0x8d, 0x8d, kInteger, kNone},                // lea
    {0x8f, 0x8f, kLoad, kStores},                 // pop
    {0x9c, 0x9c, kStore, kNone},                  // pushf
    {0x9d, 0x9d, kLoad, kNone},                   // popf
    {0xa4, 0xa5, kLoad, kNone, Extra::kStore},    // movs
    {0xa6, 0xa7, kInteger, kNone, Extra::kLoad},  // cmps
    {0xaa, 0xab, kStore, kNone},                  // stos
    {0xac, 0xad, kLoad, kNone},                   // lods
    {0xae, 0xaf, kInteger, kNone, Extra::kLoad},  // scas
    {0xc0, 0xc1, kInteger, kUpdates},             // shifts
    {0xc2, 0xc3, kBranch, kNone, Extra::kLoad},   // ret
    {0xc6, 0xc7, kInteger, kStores},              // mov
    {0xc9, 0xc9, kLoad, kNone},                   // leave
    {0xd0, 0xd3, kInteger, kUpdates},             // shifts
    {0xd8, 0xdf, kScalarFloat},                   // x87
    {0xe0, 0xe3, kBranch},                        // loop
    {0xe8, 0xe8, kBranch, kNone, Extra::kStore},  // call
    {0xe9, 0xe9, kBranch},                        // jmp
    {0xeb, 0xeb, kBranch},                        // jmp
    {0xfe, 0xfe, kInteger, kUpdates},             // inc, dec
};

constexpr Row kTwoBytes[] = {
    {0x05, 0x05, kBranch},                  // syscall
    {0x0d, 0x0d, kInteger, kNone},          // prefetch
    {0x10, 0x10, kVectorInteger, kLoads},   // movups, movss, movsd
    {0x11, 0x11, kVectorInteger, kStores},  //
    {0x12, 0x12, kVectorInteger, kLoads},   // movlps
    {0x13, 0x13, kVectorInteger, kStores},  //
    {0x14, 0x15, kVectorInteger},           // unpck
    {0x16, 0x16, kVectorInteger, kLoads},   // movhps
    {0x17, 0x17, kVectorInteger, kStores},  //
    {0x18, 0x1f, kInteger, kNone},          // nop, prefetch
    {0x28, 0x28, kVectorInteger, kLoads},   // movaps
    {0x29, 0x29, kVectorInteger, kStores},  //
    {0x2a, 0x2a, kVectorFloat},             // cvtsi2ss, cvtpi2ps
    {0x2b, 0x2b, kVectorInteger, kStores},  // movntps
    {0x2c, 0x2d, kVectorFloat},             // cvt to an integer
    {0x2e, 0x2f, kScalarFloat},             // comis
    {0x50, 0x50, kVectorInteger},           // movmsk
    {0x51, 0x51, kDivide},                  // sqrt
    {0x52, 0x53, kVectorFloat},             // rsqrt, rcp
    {0x54, 0x57, kVectorInteger},           // and, or, xor
    {0x58, 0x5d, kVectorFloat},             // add, mul, cvt, sub, min
    {0x5e, 0x5e, kDivide},                  // div
    {0x5f, 0x5f, kVectorFloat},             // max
    {0x60, 0x6d, kVectorInteger},           //
    {0x6e, 0x6f, kVectorInteger, kLoads},   // movd, movdqa
    {0x70, 0x77, kVectorInteger},           //
    {0x7c, 0x7d, kVectorFloat},             // hadd
    {0x7e, 0x7f, kVectorInteger, kStores},  // movd, movdqa; but movq, see below
    {0x80, 0x8f, kBranch},                  // jcc
    {0x90, 0x9f, kInteger, kStores},        // setcc
    {0xa0, 0xa0, kStore, kNone},            // push
    {0xa1, 0xa1, kLoad, kNone},             // pop
    {0xa4, 0xa5, kInteger, kUpdates},       // shld
    {0xa8, 0xa8, kStore, kNone},            // push
    {0xa9, 0xa9, kLoad, kNone},             // pop
    {0xab, 0xad, kInteger, kUpdates},       // bts, shrd
    {0xaf, 0xaf, kMultiply},                // imul
    {0xb0, 0xb1, kInteger, kUpdates},       // cmpxchg
    {0xb3, 0xb3, kInteger, kUpdates},       // btr
    {0xb6, 0xb7, kInteger, kLoads},         // movzx
    {0xbb, 0xbb, kInteger, kUpdates},       // btc
    {0xbe, 0xbf, kInteger, kLoads},         // movsx
    {0xc0, 0xc1, kInteger, kUpdates},       // xadd
    {0xc2, 0xc2, kVectorFloat},             // cmpps
    {0xc3, 0xc3, kInteger, kStores},        // movnti
    {0xc4, 0xc6, kVectorInteger},           // pinsrw, pextrw, shufps
    {0xc7, 0xc7, kInteger, kUpdates},       // cmpxchg16b
    {0xd0, 0xd0, kVectorFloat},             // addsub
    {0xd6, 0xd6, kVectorInteger, kStores},  // movq
    {0xe6, 0xe6, kVectorFloat},             // cvt
    {0xe7, 0xe7, kVectorInteger, kStores},  // movntdq
    {0xf0, 0xf0, kVectorInteger, kLoads},   // lddqu
    {0xd1, 0xfe, kVectorInteger},           //
};

constexpr Row kThreeBytes38[] = {
    {0x13, 0x13, kVectorFloat},             // vcvtph2ps
    {0x18, 0x1a, kVectorInteger, kLoads},   // broadcast
    {0x20, 0x25, kVectorInteger, kLoads},   // pmovsx
    {0x2a, 0x2a, kVectorInteger, kLoads},   // movntdqa
    {0x2c, 0x2d, kVectorInteger, kLoads},   // vmaskmov
    {0x2e, 0x2f, kVectorInteger, kStores},  //
    {0x30, 0x35, kVectorInteger, kLoads},   // pmovzx
    {0x58, 0x5a, kVectorInteger, kLoads},   // broadcast
    {0x78, 0x79, kVectorInteger, kLoads},   // broadcast
    {0x8c, 0x8c, kVectorInteger, kLoads},   // vpmaskmov
    {0x8e, 0x8e, kVectorInteger, kStores},  //
    {0x96, 0xbf, kVectorFloat},             // fused multiply-add
    {0xf0, 0xf0, kInteger, kLoads},         // movbe, crc32
    {0xf1, 0xf1, kInteger, kStores},        // movbe, crc32
    {0xf6, 0xf6, kMultiply},                // mulx
    {0xf2, 0xf7, kInteger},                 // andn, bzhi, pext, shifts
    {0x00, 0xef, kVectorInteger},           //
};

constexpr Row kThreeBytes3a[] = {
    {0x08, 0x09, kVectorFloat},             // roundps
    {0x0a, 0x0b, kScalarFloat},             // roundss
    {0x14, 0x17, kVectorInteger, kStores},  // pextr
    {0x19, 0x19, kVectorInteger, kStores},  // vextractf128
    {0x1d, 0x1d, kVectorFloat, kStores},    // vcvtps2ph
    {0x39, 0x39, kVectorInteger, kStores},  // vextracti128
    {0x40, 0x41, kVectorFloat},             // dpps
    {0xf0, 0xf0, kInteger},                 // rorx
    {0x00, 0xef, kVectorInteger},           //
};

/// Of an opcode whose work depends on the middle bits of its ModRM byte.
std::optional<Row> by_extension(Byte opcode, int extension) {
  const bool is_wide = (opcode & 1) != 0;
  if (opcode >= 0x80 && opcode <= 0x83 && extension == 7) return Row{0, 0, kInteger};  // cmp
  if (opcode == 0xf6 || opcode == 0xf7) {
    if (extension < 2) return Row{0, 0, kInteger};            // test
    if (extension < 4) return Row{0, 0, kInteger, kUpdates};  // not, neg
    return Row{0, 0, extension < 6 ? kMultiply : kDivide};
  }
  if (opcode != 0xff || !is_wide) return std::nullopt;
  if (extension < 2) return Row{0, 0, kInteger, kUpdates};  // inc, dec
  if (extension < 4) return Row{0, 0, kBranch, kRead, Extra::kStore};
  if (extension < 6) return Row{0, 0, kBranch};
  return Row{0, 0, kStore};  // push
}

/// The prefixes and the opcode of an instruction.
struct Decoded {
  int map = 1;  ///< 1: one byte, 2: 0f, 3: 0f38, 4: 0f3a
  Byte opcode = 0x90;
  Byte modrm = 0xc0;
  bool has_modrm = false;
  bool is_vex = false;
  bool is_locked = false;
  Byte mandatory = 0;  ///< 66, f2 or f3
};

class Reader {
 public:
  explicit Reader(std::span<const Byte> bytes) : bytes_(bytes) {}
  Byte peek() const { return at_ < bytes_.size() ? bytes_[at_] : Byte{0}; }
  Byte next() {
    const Byte byte = peek();
    ++at_;
    return byte;
  }
  bool has_more() const { return at_ < bytes_.size(); }

 private:
  std::span<const Byte> bytes_;
  std::size_t at_ = 0;
};

void read_vex(Reader& bytes, Decoded& result) {
  constexpr Byte kMandatory[] = {0, 0x66, 0xf3, 0xf2};
  const bool is_long = bytes.next() == 0xc4;
  Byte last = bytes.next();
  result.map = 2;
  if (is_long) {
    result.map = std::clamp((last & 0x1f) + 1, 2, 4);
    last = bytes.next();
  }
  result.mandatory = kMandatory[last & 3];
  result.is_vex = true;
}

/// @returns whether there was a prefix
bool read_prefix(Reader& bytes, Decoded& result) {
  switch (const Byte byte = bytes.peek()) {
    case 0x66:
      if (result.mandatory == 0) result.mandatory = byte;
      break;
    case 0xf2:
    case 0xf3:
      result.mandatory = byte;
      break;
    case 0xf0:
      result.is_locked = true;
      break;
    case 0x26:
    case 0x2e:
    case 0x36:
    case 0x3e:
    case 0x64:
    case 0x65:
    case 0x67:
      break;
    default:
      if (byte < 0x40 || byte > 0x4f) return false;  // REX
  }
  bytes.next();
  return true;
}

Decoded decoded(std::span<const Byte> instruction) {
  Decoded result;
  Reader bytes(instruction);
  while (bytes.has_more() && read_prefix(bytes, result)) {
  }
  if (bytes.peek() == 0xc4 || bytes.peek() == 0xc5) {
    read_vex(bytes, result);
  } else if (bytes.peek() == 0x0f) {
    bytes.next();
    result.map = bytes.peek() == 0x38 ? 3 : bytes.peek() == 0x3a ? 4 : 2;
    if (result.map > 2) bytes.next();
  }
  result.opcode = bytes.next();
  result.has_modrm = bytes.has_more();
  if (result.has_modrm) result.modrm = bytes.peek();
  return result;
}

template <std::size_t N>
Row find(const Row (&table)[N], Byte opcode) {
  for (const Row& row : table)
    if (opcode >= row.first && opcode <= row.last) return row;
  return {0, 0, kInteger};
}

Row one_byte(const Decoded& i) {
  if (const auto row = by_extension(i.opcode, i.modrm >> 3 & 7)) return *row;
  // add, or, adc, sbb, and, sub, xor: with a destination in memory in the first two forms.
  if (i.opcode < 0x38) return {0, 0, kInteger, (i.opcode & 7) < 2 ? kUpdates : kRead};
  return find(kOneByte, i.opcode);
}

/// Floating-point work on one number rather than on a vector.
bool is_scalar(const Decoded& i) {
  if (i.map == 3) return i.opcode % 2 == 1 && i.opcode % 16 >= 9;
  return i.map == 2 && (i.mandatory == 0xf2 || i.mandatory == 0xf3) && i.opcode != 0xd0 &&
         i.opcode != 0xe6 && i.opcode != 0x7c && i.opcode != 0x7d &&
         !(i.opcode == 0x5b && i.mandatory == 0xf3);
}

Row row_of(const Decoded& i) {
  Row row = i.map == 1   ? one_byte(i)
            : i.map == 2 ? find(kTwoBytes, i.opcode)
            : i.map == 3 ? find(kThreeBytes38, i.opcode)
                         : find(kThreeBytes3a, i.opcode);
  if (i.map == 2 && i.opcode == 0x7e && i.mandatory == 0xf3) row.memory = kLoads;  // movq
  if (row.work == kVectorFloat && is_scalar(i)) row.work = kScalarFloat;
  return row;
}

/// Opcodes of one byte whose next byte is no ModRM, but part of a number.
bool takes_modrm(const Decoded& i) {
  if (i.map != 1) return !(i.map == 2 && i.opcode >= 0x80 && i.opcode <= 0x8f);
  const Byte o = i.opcode;
  if (o < 0x40) return (o & 7) < 4;
  return o == 0x63 || o == 0x69 || o == 0x6b || (o >= 0x80 && o <= 0x8f) || o == 0xc0 ||
         o == 0xc1 || o == 0xc6 || o == 0xc7 || (o >= 0xd0 && o <= 0xd3) ||
         (o >= 0xd8 && o <= 0xdf) || o == 0xf6 || o == 0xf7 || o >= 0xfe;
}

}  // namespace

void add_x86_64(std::span<const std::uint8_t> instruction, Work& work) {
  const Decoded i = decoded(instruction);
  const Row row = row_of(i);
  const bool in_memory = i.has_modrm && takes_modrm(i) && i.modrm < 0xc0;
  const auto add = [&](WorkClass kind) { ++work[static_cast<std::size_t>(kind)]; };
  const bool is_exchange = i.map == 1 && (i.opcode == 0x86 || i.opcode == 0x87);
  if (in_memory && (i.is_locked || is_exchange)) return add(kAtomic);

  const bool is_move = in_memory && (row.memory == kLoads || row.memory == kStores);
  if (!is_move || row.work == kLoad) add(row.work);
  const bool uses = in_memory && row.memory != kNone;
  if ((uses && row.memory != kStores) || row.extra == Extra::kLoad) add(kLoad);
  if ((uses && (row.memory == kStores || row.memory == kUpdates)) || row.extra == Extra::kStore)
    add(kStore);
}

}  // namespace tether::counter
