# SPDX-License-Identifier: GPL-3.0-or-later
# Each folder is one target with one responsibility.

find_program(WATERTIGHT_CCACHE ccache)
if(WATERTIGHT_CCACHE)
  set(CMAKE_C_COMPILER_LAUNCHER "${WATERTIGHT_CCACHE}")
  set(CMAKE_CXX_COMPILER_LAUNCHER "${WATERTIGHT_CCACHE}")
endif()

# Programs name their sources as paths from the root, so that each checkout gives the same bytes: the
# compiler's cache then serves all of them.
add_compile_options("-ffile-prefix-map=${PROJECT_SOURCE_DIR}/=")

# With CMAKE_UNITY_BUILD (the gate has it) a compiler reads so many files of a folder as one.
# A name that two of them give to different things is an error there.
set(CMAKE_UNITY_BUILD_BATCH_SIZE 12)

# The options with which every target of the project is compiled. Contraction is off so that each
# machine and compiler computes the same doubles.
add_library(watertight_options INTERFACE)
target_include_directories(watertight_options INTERFACE "${PROJECT_SOURCE_DIR}")
target_compile_options(watertight_options INTERFACE
  -ffp-contract=off
  $<$<COMPILE_LANGUAGE:CXX>:-Wall -Wextra -Wpedantic -Wconversion -Wshadow>
  $<$<AND:$<COMPILE_LANGUAGE:CXX>,$<BOOL:${WATERTIGHT_WERROR}>>:-Werror>)
if(CMAKE_UNITY_BUILD) # the file that a compiler is given is not that of an anonymous namespace
  target_compile_options(watertight_options INTERFACE -ffunction-sections -fdata-sections # see tests/core
    $<$<AND:$<COMPILE_LANGUAGE:CXX>,$<CXX_COMPILER_ID:GNU>>:-Wno-subobject-linkage>)
endif()
target_compile_definitions(watertight_options INTERFACE $<$<CONFIG:Debug>:WATERTIGHT_CHECKED=1>)
if(WATERTIGHT_SANITIZE)
  target_compile_options(watertight_options INTERFACE
    -fsanitize=${WATERTIGHT_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer
    -fno-sanitize=null,vptr) # a sixth of the compiler's time; an access to address zero ends the program anyway
  target_link_options(watertight_options INTERFACE -fsanitize=${WATERTIGHT_SANITIZE})
  target_compile_definitions(watertight_options INTERFACE WATERTIGHT_CHECKED=1)
endif()
if(WATERTIGHT_FUZZ)
  target_compile_options(watertight_options INTERFACE -fsanitize=fuzzer-no-link)
endif()

# CGAL as a header-only system dependency, whose headers give no warnings. CGAL::CGAL brings the
# compiler option for the rounding mode that EPICK sets.
add_library(watertight_cgal INTERFACE)
target_link_libraries(watertight_cgal INTERFACE CGAL::CGAL)
target_compile_definitions(watertight_cgal INTERFACE CGAL_NDEBUG=1)

# watertight_folder(NAME SOURCES files... DEPENDS folders... [PRIVATE third-party targets...])
# Declares the library watertight_NAME. DEPENDS is the list of folders whose headers NAME may
# include: the link line and tests/architecture both read it.
function(watertight_folder name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SOURCES;DEPENDS;PRIVATE")
  set(libraries)
  foreach(folder IN LISTS arg_DEPENDS)
    list(APPEND libraries watertight_${folder})
  endforeach()
  if(arg_SOURCES)
    add_library(watertight_${name} STATIC ${arg_SOURCES})
    target_link_libraries(watertight_${name} PUBLIC watertight_options ${libraries} PRIVATE ${arg_PRIVATE})
  else()
    add_library(watertight_${name} INTERFACE)
    target_link_libraries(watertight_${name} INTERFACE watertight_options ${libraries})
  endif()
endfunction()

# watertight_embed(FOLDER FILE BYTES|TEXT NAME)
# Builds FILE into the library of FOLDER, as the constant NAME of the folder's namespace.
function(watertight_embed folder file kind name)
  set(script "${PROJECT_SOURCE_DIR}/cmake/embed.cmake")
  cmake_path(GET file FILENAME source)
  set(source "${CMAKE_CURRENT_BINARY_DIR}/${source}.cpp")
  cmake_path(ABSOLUTE_PATH file)
  add_custom_command(OUTPUT "${source}"
    COMMAND "${CMAKE_COMMAND}" "-DINPUT=${file}" "-DOUTPUT=${source}" -DNAMESPACE=watertight::${folder}
      -DNAME=${name} -DKIND=${kind} -P "${script}"
    DEPENDS "${file}" "${script}"
    VERBATIM)
  set_source_files_properties("${source}" PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  target_sources(watertight_${folder} PRIVATE "${source}")
endfunction()
