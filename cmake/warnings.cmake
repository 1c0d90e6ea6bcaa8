# kerf::warnings - how our own code is compiled: strict, and never with finite-math assumptions
# (NaN checks would vanish).
add_library(kerf_warnings INTERFACE)
add_library(kerf::warnings ALIAS kerf_warnings)
target_compile_options(kerf_warnings INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion
                                               -Wno-sign-conversion -Werror)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # It calls its own AVX-512 intrinsics, which Eigen uses, uninitialized (GCC bug 105593), and text
  # + std::string overlapping (GCC bug 105651).
  target_compile_options(kerf_warnings INTERFACE -Wno-uninitialized -Wno-maybe-uninitialized
                                                 -Wno-restrict)
endif()
if(KERF_NATIVE)
  target_compile_options(kerf_warnings INTERFACE -march=native)
endif()
if(KERF_SANITIZE)
  add_compile_options(-fsanitize=${KERF_SANITIZE} -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${KERF_SANITIZE})
endif()
