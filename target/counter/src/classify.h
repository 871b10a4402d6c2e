#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <tether/base/count_page.h>

/// Which work an instruction is, from its bytes. Needs nothing but the bytes, so that the same
/// program counts the same with every version of the emulator.
namespace tether::counter {

/// How often each kind of work is done, in the order of WorkClass.
using Work = std::array<std::uint32_t, kWorkClasses>;

/// Adds the work of one instruction for x86-64 or 64-bit ARM to `work`. An instruction that is not
/// known is integer work, or vector work if its opcode is among those.
/// @{
void add_x86_64(std::span<const std::uint8_t> instruction, Work& work);
void add_aarch64(std::uint32_t instruction, Work& work);
/// @}

}  // namespace tether::counter
