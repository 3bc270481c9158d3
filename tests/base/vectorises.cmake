# Fails when gcc leaves a loop of fmath_loops.c scalar, for each instruction set that kiln's stages are compiled for.
file(READ ${FOLDER}/fmath_loops.h header)
string(REGEX MATCHALL " X\\([a-z0-9_]+," rows "${header}")
list(LENGTH rows wanted)
foreach(set "x86-64-v2 16" "x86-64-v3 32" "x86-64-v4 64")
  string(REPLACE " " ";" set ${set})
  list(GET set 0 march)
  list(GET set 1 bytes)
  execute_process(
    COMMAND ${COMPILER} -std=gnu11 -O3 -march=${march} -ffp-contract=off -fno-math-errno -fno-trapping-math
      --param=max-tree-if-conversion-phi-args=8 -fopt-info-vec-optimized -I${SOURCE} -I${FOLDER} -c ${FOLDER}/fmath_loops.c -o fmath_loops.${march}.o
    ERROR_VARIABLE log RESULT_VARIABLE status)
  string(REGEX MATCHALL "loop vectorized using ${bytes} byte" loops "${log}")
  list(LENGTH loops found)
  if(NOT status EQUAL 0 OR NOT found EQUAL wanted)
    message(FATAL_ERROR "${march}: ${found} of ${wanted} loops use vectors of ${bytes} bytes\n${log}")
  endif()
  message(STATUS "${march}: all ${wanted} loops use vectors of ${bytes} bytes")
endforeach()
