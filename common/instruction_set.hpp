// Which of the compiled variants of a kernel this machine runs best.
#pragma once

#include <cstdlib>
#include <string_view>

namespace kerf {

enum class InstructionSet { baseline, avx2, avx512 };

inline InstructionSet best_instruction_set() {
  if (__builtin_cpu_supports("x86-64-v4"))
    return InstructionSet::avx512;
  return __builtin_cpu_supports("x86-64-v3") ? InstructionSet::avx2 : InstructionSet::baseline;
}

/// The best set of this machine, or a lesser one that the environment names in KERF_INSTRUCTIONS.
/// The same for the whole process; results have the same bits only with the same set.
inline InstructionSet instruction_set() {
  static const InstructionSet chosen = [] {
    const InstructionSet best = best_instruction_set();
    const char* const text = std::getenv("KERF_INSTRUCTIONS");
    const std::string_view wanted = text == nullptr ? "" : text;
    if (wanted == "baseline")
      return InstructionSet::baseline;
    if (wanted == "avx2" && best == InstructionSet::avx512)
      return InstructionSet::avx2;
    return best;
  }();
  return chosen;
}

inline const char* name_of(InstructionSet set) {
  switch (set) {
  case InstructionSet::avx512:
    return "avx512";
  case InstructionSet::avx2:
    return "avx2";
  case InstructionSet::baseline:
    break;
  }
  return "baseline";
}

/// One of three functions, by instruction_set().
template <class Function> Function dispatch(Function baseline, Function avx2, Function avx512) {
  switch (instruction_set()) {
  case InstructionSet::avx512:
    return avx512;
  case InstructionSet::avx2:
    return avx2;
  case InstructionSet::baseline:
    break;
  }
  return baseline;
}

} // namespace kerf
