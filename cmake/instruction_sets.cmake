# Which set this machine runs.
set(KERF_BEST_SET baseline)
if(EXISTS /proc/cpuinfo)
  file(STRINGS /proc/cpuinfo flags REGEX "^flags" LIMIT_COUNT 1)
  if(flags MATCHES " avx512vl")
    set(KERF_BEST_SET avx512)
  elseif(flags MATCHES " avx2")
    set(KERF_BEST_SET avx2)
  endif()
endif()

# kerf_add_kernels(TARGET FILES…) - compiles hot kernels once for every set of instructions, each in
# the namespace kerf::<set>; common/instruction_set.hpp tells at run time which one to call.
function(kerf_add_kernels target)
  # -fno-tree-pre: g++ 12 fails on what partial redundancy elimination makes of masks there.
  set(flags_baseline -march=x86-64 -mtune=generic -fno-tree-pre)
  set(flags_avx2 -march=x86-64-v3 -mtune=generic)
  set(flags_avx512 -march=x86-64-v4 -mtune=generic -mprefer-vector-width=512)
  foreach(set baseline avx2 avx512)
    add_library(${target}_${set} OBJECT ${ARGN})
    target_compile_definitions(${target}_${set} PRIVATE KERF_ISA=${set})
    target_include_directories(${target}_${set} PRIVATE ${PROJECT_SOURCE_DIR})
    target_link_libraries(${target}_${set} PRIVATE kerf::warnings)
    # -Wno-psabi: vectors as parameters of functions that are always inlined.
    target_compile_options(${target}_${set} PRIVATE ${flags_${set}} -fno-tree-vectorize -fno-math-errno -fno-trapping-math
                                                        -Wno-psabi)
    if(KERF_SANITIZE AND NOT set STREQUAL KERF_BEST_SET)
      target_compile_options(${target}_${set} PRIVATE -fno-sanitize=all) # it does not run here
    endif()
    target_sources(${target} PRIVATE $<TARGET_OBJECTS:${target}_${set}>)
  endforeach()
endfunction()
