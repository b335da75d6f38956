# SPDX-License-Identifier: GPL-3.0-or-later
# Fails unless the two programs exit with status 0 and print the same text.
foreach(program IN ITEMS OPTIMIZED PLAIN)
  execute_process(COMMAND "${${program}}" OUTPUT_VARIABLE ${program}_OUTPUT RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${${program}} ended with ${status}: ${${program}_OUTPUT}")
  endif()
endforeach()
if(OPTIMIZED_OUTPUT STREQUAL "" OR NOT OPTIMIZED_OUTPUT STREQUAL PLAIN_OUTPUT)
  message(FATAL_ERROR "the outputs differ:\n${OPTIMIZED_OUTPUT}\n${PLAIN_OUTPUT}")
endif()
