# No -ffast-math: NaN checks must hold. -ffp-contract=off: the same bits with and without FMA hardware.
# -fno-math-errno and -fno-trapping-math let gcc vectorise select and sqrt; neither changes a result.
add_library(kiln_flags INTERFACE)
target_include_directories(kiln_flags INTERFACE ${CMAKE_SOURCE_DIR} ${CMAKE_SOURCE_DIR}/include)
target_compile_definitions(kiln_flags INTERFACE _GNU_SOURCE)
target_compile_options(kiln_flags INTERFACE
  -ffp-contract=off -fno-math-errno -fno-trapping-math -fno-strict-aliasing
  -Wall -Wextra -Wshadow -Wundef -Wpointer-arith -Wvla
  $<$<COMPILE_LANGUAGE:C>:-Wconversion -Wstrict-prototypes -Wmissing-prototypes -Werror=switch-enum>
  $<$<BOOL:${KILN_WERROR}>:-Werror>)
if(CMAKE_C_COMPILER_ID STREQUAL GNU)
  # gcc 14 merges chains of selects into one node of five edges, and by default turns at most four back into selects.
  target_compile_options(kiln_flags INTERFACE --param=max-tree-if-conversion-phi-args=8)
endif()
target_link_libraries(kiln_flags INTERFACE m Threads::Threads)
if(KILN_SANITIZE)
  # Functions and lines are all that a report names; to track variables takes two thirds of the compiler's time.
  set(CMAKE_C_FLAGS_DEBUG "-g1")
  set(CMAKE_CXX_FLAGS_DEBUG "-g1")
  target_compile_options(kiln_flags INTERFACE -fsanitize=${KILN_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(kiln_flags INTERFACE -fsanitize=${KILN_SANITIZE})
endif()
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  # In the global flags, which stand first: of several -march the last one counts, and the stages have their own.
  string(APPEND CMAKE_C_FLAGS " -march=x86-64-v2")
  string(APPEND CMAKE_CXX_FLAGS " -march=x86-64-v2")
endif()
set(CMAKE_C_FLAGS_RELEASE "-O3 -DNDEBUG -g1")
set(CMAKE_CXX_FLAGS_RELEASE "-O2 -DNDEBUG -g1")

# kiln_module(name sources… [USES modules and packages…]): a static library of one folder. USES is the wall: what is
# not listed cannot be linked, and tests/walls checks the includes.
function(kiln_module name)
  cmake_parse_arguments(M "" "" "SOURCES;USES" ${ARGN})
  add_library(kiln_${name} STATIC ${M_SOURCES})
  target_link_libraries(kiln_${name} PUBLIC kiln_flags PRIVATE ${M_USES})
endfunction()
