# SPDX-License-Identifier: Apache-2.0
# How every target of the project is compiled: one interface target, kinfer_flags.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()

# Released programs stop at an index outside of a vector, a smashed stack or an overrun buffer instead of going on; what
# that costs is measured (docs/development/results.md).
option(KINFER_HARDENED "Checks of the standard library, the stack and buffers in optimised builds" ON)
add_library(kinfer_hardening INTERFACE)  # of optimised code: fortified functions are inline functions
if(KINFER_HARDENED AND NOT KINFER_SANITIZE AND NOT KINFER_SANITIZE_THREADS AND NOT CMAKE_BUILD_TYPE STREQUAL "Debug")
  add_compile_definitions(_GLIBCXX_ASSERTIONS)
  if(KINFER_PACKAGE)  # small: the stack is guarded where there are arrays of characters, not where a vector of three numbers lies
    add_compile_options(-fstack-protector)
  else()
    # Without -fstack-clash-protection, which doubles the cost (1.0 to 2.1 %): the kernel keeps a gap of a megabyte below
    # the stack, and no frame may be a quarter of that.
    add_compile_options(-fstack-protector-strong -Wframe-larger-than=262144)
    if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
      add_compile_options(-fcf-protection)
    endif()
  endif()
  add_link_options(-Wl,-z,relro,-z,now)
  target_compile_options(kinfer_hardening INTERFACE -U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=2)
endif()

# Several files of a target are compiled as one (a unity build): Eigen, fmt and gtest are parsed once per batch. Names in
# anonymous namespaces must then differ within a batch; a file that cannot comply is compiled alone
# (SKIP_UNITY_BUILD_INCLUSION).
option(KINFER_UNITY "Compile files in batches: a whole build takes half the time, one changed file a few seconds more" ON)

# Levels of optimisation: of rooms that call loops of other rooms, and of programs, which call nothing but the library.
# Optimising either would double the time that they compile; a package is compiled once and copied often.
set(KINFER_CALLER_LEVEL $<$<NOT:$<CONFIG:Debug>>:$<IF:$<BOOL:${KINFER_PACKAGE}>,-Oz,-O1>>)
set(KINFER_PROGRAM_LEVEL $<$<NOT:$<CONFIG:Debug>>:$<IF:$<BOOL:${KINFER_PACKAGE}>,-Oz,-O0>>)
if(KINFER_PACKAGE AND CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  # At -Oz clang inlines next to nothing; a function of a few instructions is smaller inlined than its tables for unwinding.
  set(little_functions "SHELL:-mllvm -inline-threshold=10")
  list(APPEND KINFER_CALLER_LEVEL ${little_functions})
  list(APPEND KINFER_PROGRAM_LEVEL ${little_functions})
endif()

add_library(kinfer_flags INTERFACE)
target_compile_options(kinfer_flags INTERFACE
  -Wall -Wextra -Wpedantic -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor -Woverloaded-virtual
  -Werror
  -ffp-contract=off)  # the same answer from every compiler; kernels use explicit fused multiply-adds
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # False positives of gcc 12 in inlined Eigen and std::string code at -O3.
  target_compile_options(kinfer_flags INTERFACE -Wno-maybe-uninitialized -Wno-array-bounds -Wno-stringop-overflow -Wno-restrict)
  # A precompiled header fills the compiler's heap so far that it collects garbage repeatedly, a tenth of its time.
  target_compile_options(kinfer_flags INTERFACE --param=ggc-min-heapsize=2000000)  # [kB]
endif()
# In a batch, a local name may equal a name of another file; files compiled alone get the full warning.
if(NOT KINFER_UNITY)
  target_compile_options(kinfer_flags INTERFACE -Wshadow)
elseif(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  target_compile_options(kinfer_flags INTERFACE -Wshadow=local)
endif()

if(KINFER_PACKAGE)
  # Each function is a section of its own, so that the linker can leave out what nobody calls.
  add_compile_options(-ffunction-sections -fdata-sections)
  add_compile_options(-fno-asynchronous-unwind-tables)  # tables for exceptions alone
  add_compile_options(-include ${PROJECT_SOURCE_DIR}/cmake/short_assertions.hpp)
  add_compile_options(-ffile-prefix-map=${PROJECT_BINARY_DIR}=. -ffile-prefix-map=${PROJECT_SOURCE_DIR}=.)
endif()

if(KINFER_SANITIZE)
  add_compile_options(-fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)
  # Eigen forms pointers into empty matrices, which it never reads. Null, misaligned and foreign objects are found where
  # they are used, by the processor and the address sanitizer: checks before each access take as long as everything else.
  add_compile_options(-fno-sanitize=pointer-overflow,null,alignment,object-size,vptr)
  if(CMAKE_CXX_COMPILER_ID MATCHES "Clang")
    # No checks of what lies on the stack and provably stays within it; the default from clang 15 on.
    add_compile_options("SHELL:-mllvm -asan-use-stack-safety=1")
    add_compile_options(-fsanitize-ignorelist=${CMAKE_CURRENT_LIST_DIR}/undefined_behaviour_ignorelist.txt)
  endif()
  add_link_options(-fsanitize=address,undefined)
endif()
if(KINFER_SANITIZE_THREADS)
  add_compile_options(-fsanitize=thread -fno-omit-frame-pointer)
  add_link_options(-fsanitize=thread)
endif()
if(KINFER_FUZZ)
  add_compile_options(-fsanitize=fuzzer-no-link)  # counts which branches an input takes
endif()

find_program(KINFER_CCACHE ccache)
if(KINFER_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER
      ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${CMAKE_SOURCE_DIR} CCACHE_NOHASHDIR=1
      CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime ${KINFER_CCACHE})
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    add_compile_options(-fpch-preprocess)  # what ccache needs to cache files that use a precompiled header
  elseif(CMAKE_CXX_COMPILER_ID MATCHES "Clang")
    add_compile_options("SHELL:-Xclang -fno-pch-timestamp")  # likewise
  endif()
endif()

# Eigen takes longer to parse than most source files: it is precompiled, and so are the headers of our own that most files
# include. `#include` lines stay complete nevertheless.
set(KINFER_PRECOMPILED <Eigen/Core> <Eigen/Geometry> <fmt/format.h> <fmt/ranges.h> <tl/expected.hpp>
  <algorithm> <array> <cmath> <filesystem> <functional> <limits> <map> <memory> <numbers> <optional> <set> <span> <string>
  <string_view> <variant> <vector> <kinfer/kinematics/chain.hpp> <kinfer/measurement/pose_set.hpp>
  <kinfer/measurement/ins/ins_recording.hpp> <kinfer/evidence/calibration/calibration.hpp>
  <kinfer/evidence/identification/identification.hpp>)

# An object library that holds only a precompiled header, which targets with the same flags use by REUSE_FROM.
function(kinfer_header_library name)
  file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp CONTENT "// holds the precompiled header\n")
  add_library(${name} OBJECT ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp)
  target_precompile_headers(${name} PRIVATE ${KINFER_PRECOMPILED} ${ARGN})
endfunction()

function(kinfer_batches target size)
  if(KINFER_UNITY)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${size})
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
      target_compile_options(${target} PRIVATE -Wno-subobject-linkage)  # it mistakes the files of a batch for headers
    endif()
  endif()
endfunction()

find_program(KINFER_MOLD mold)
if(KINFER_MOLD)
  add_link_options(-fuse-ld=mold)
endif()
